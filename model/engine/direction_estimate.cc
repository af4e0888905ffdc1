#include "model/engine/direction_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "model/motion/standardise.h"

namespace duet::engine {
namespace {

constexpr double kMostDeviations = 3;
// A third correction changes the error by 2 %.
constexpr int kCorrections = 2;

bool HipsHaveDirection(const motion::Skeleton& skeleton, const motion::Poses& leader) {
  if (!skeleton.hips) return false;
  const motion::Vec3 across =
      leader.at(0, skeleton.hips->right) - leader.at(0, skeleton.hips->left);
  return across.x != 0 || across.z != 0;
}

// The leader's first root at the origin, the hips along +x, facing -z.
motion::Standardisation HipFrame(const motion::Skeleton& skeleton, const motion::Poses& leader) {
  return {skeleton, leader, motion::YawDirection::kRemove, motion::StandardOrigin::kFirstFrame};
}

motion::Vec3 MeanPlace(const motion::Poses& poses, int joint) {
  motion::Vec3 sum;
  for (int t = 0; t < poses.frame_count(); ++t) sum += poses.at(t, joint);
  return sum / static_cast<float>(poses.frame_count());
}

double Product(const std::vector<double>& factors, const std::vector<double>& features) {
  return std::inner_product(factors.begin(), factors.end(), features.begin(), 0.0);
}

double Angle(const AngleRegression& regression, const std::vector<double>& features) {
  const std::vector<double> scaled = ScaledFeatures(regression, features);
  return std::atan2(Product(regression.sine, scaled), Product(regression.cosine, scaled));
}

double Correction(const DirectionCorrection& correction, const std::vector<double>& features,
                  const std::vector<double>& shares) {
  const std::vector<double> scaled = ScaledFeatures(correction, features);
  double sine = Product(correction.sine, scaled);
  double cosine = Product(correction.cosine, scaled);
  for (std::size_t c = 0; c < shares.size() && c < correction.classes.size(); ++c) {
    if (shares[c] == 0) continue;
    sine += shares[c] * Product(correction.classes[c].sine, scaled);
    cosine += shares[c] * Product(correction.classes[c].cosine, scaled);
  }
  return std::atan2(sine, cosine);
}

}  // namespace

std::optional<std::vector<double>> DirectionFeatures(const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader) {
  if (!HipsHaveDirection(skeleton, leader)) return std::nullopt;
  const motion::Poses seen = HipFrame(skeleton, leader).Apply(leader);
  std::vector<double> features;
  const auto add = [&](motion::Vec3 place) {
    features.push_back(place.x);
    features.push_back(place.z);
  };
  const motion::Vec3 root = MeanPlace(seen, skeleton.root);
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    if (joint != skeleton.root) add(MeanPlace(seen, joint) - root);
  }
  add(root);
  add(seen.at(seen.frame_count() - 1, skeleton.root));
  features.push_back(1);
  return features;
}

std::vector<double> ScaledFeatures(const AngleRegression& regression,
                                   std::vector<double> features) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    features[i] = std::clamp((features[i] - regression.mean[i]) / regression.deviation[i],
                             -kMostDeviations, kMostDeviations);
  }
  return features;
}

std::vector<double> TurnedFeatures(std::vector<double> features, double angle) {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  for (std::size_t i = 0; i + 1 < features.size(); i += 2) {
    const double x = features[i], z = features[i + 1];
    features[i] = cosine * x + sine * z;
    features[i + 1] = cosine * z - sine * x;
  }
  return features;
}

std::vector<double> ClassShares(absl::Span<const float> labels, int classes) {
  std::vector<double> shares(static_cast<std::size_t>(classes), 0);
  if (labels.empty() || shares.empty()) return shares;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    shares[i % shares.size()] += std::max(labels[i], 0.0f);
  }
  const double frames = static_cast<double>(labels.size() / shares.size());
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= std::max(sum, frames);
  return shares;
}

std::optional<motion::Vec3> EstimatePartnerDirection(const DirectionRegression& regression,
                                                     const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader,
                                                     absl::Span<const float> labels) {
  const std::optional<std::vector<double>> features = DirectionFeatures(skeleton, leader);
  if (!features) return std::nullopt;
  double angle = Angle(regression, *features);
  if (regression.correction) {
    const std::vector<double> shares =
        ClassShares(labels, static_cast<int>(regression.correction->classes.size()));
    for (int i = 0; i < kCorrections; ++i) {
      angle += Correction(*regression.correction, TurnedFeatures(*features, angle), shares);
    }
  }
  const motion::Vec3 seen = {static_cast<float>(std::sin(angle)), 0,
                             static_cast<float>(-std::cos(angle))};
  return RotateY(seen, -HipFrame(skeleton, leader).yaw());
}

}  // namespace duet::engine
