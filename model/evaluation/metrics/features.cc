#include "model/evaluation/metrics/features.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::evaluation::metrics {
namespace {

absl::Status CheckFeatures(const char* set, const FeatureSet& features, size_t width) {
  if (features.size() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("features ", set, ": expected at least 2 samples, got ", features.size()));
  }
  for (size_t i = 0; i < features.size(); ++i) {
    if (features[i].size() != width || width == 0) {
      return absl::InvalidArgumentError(absl::StrCat("features ", set, "[", i, "]: expected ",
                                                     std::max<size_t>(width, 1), " values, got ",
                                                     features[i].size()));
    }
    if (!std::all_of(features[i].begin(), features[i].end(),
                     [](float value) { return std::isfinite(value); })) {
      return absl::InvalidArgumentError(
          absl::StrCat("features ", set, "[", i, "]: expected finite values, got others"));
    }
  }
  return absl::OkStatus();
}

// A Gaussian as its mean and a factor R with covariance R^T R.
struct Gaussian {
  Eigen::RowVectorXd mean;
  Eigen::MatrixXd factor;  // [min(samples, features), features]
};

Gaussian Fit(const FeatureSet& features) {
  const Eigen::Index samples = static_cast<Eigen::Index>(features.size());
  const Eigen::Index width = static_cast<Eigen::Index>(features[0].size());
  Eigen::MatrixXd rows(samples, width);
  for (Eigen::Index i = 0; i < samples; ++i) {
    rows.row(i) =
        Eigen::Map<const Eigen::RowVectorXf>(features[static_cast<size_t>(i)].data(), width)
            .cast<double>();
  }
  Gaussian gaussian;
  gaussian.mean = rows.colwise().mean();
  rows.rowwise() -= gaussian.mean;
  rows /= std::sqrt(static_cast<double>(samples - 1));
  if (samples > width) {
    // rows = Q R: the same covariance with as many rows as features.
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
    rows = Eigen::MatrixXd(qr.matrixQR().topRows(width).triangularView<Eigen::Upper>());
  }
  gaussian.factor = std::move(rows);
  return gaussian;
}

}  // namespace

absl::StatusOr<double> FrechetDistance(const FeatureSet& a, const FeatureSet& b) {
  const size_t width = a.empty() ? 0 : a[0].size();
  absl::Status status = CheckFeatures("a", a, width);
  if (status.ok()) status = CheckFeatures("b", b, width);
  if (!status.ok()) return status;
  const Gaussian first = Fit(a), second = Fit(b);
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(first.factor * second.factor.transpose());
  const double distance = (first.mean - second.mean).squaredNorm() + first.factor.squaredNorm() +
                          second.factor.squaredNorm() - 2 * svd.singularValues().sum();
  return std::max(0.0, distance);
}

double Diversity(const FeatureSet& features) {
  double sum = 0, pairs = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      double squared = 0;
      for (size_t k = 0; k < features[i].size(); ++k) {
        const double difference = double{features[i][k]} - features[j][k];
        squared += difference * difference;
      }
      sum += std::sqrt(squared);
      ++pairs;
    }
  }
  return pairs == 0 ? 0 : sum / pairs;
}

}  // namespace duet::evaluation::metrics
