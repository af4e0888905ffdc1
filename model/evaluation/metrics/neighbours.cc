#include "model/evaluation/metrics/neighbours.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::evaluation::metrics {
namespace {

double SquaredDistance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double difference = double{a[i]} - double{b[i]};
    sum += difference * difference;
  }
  return sum;
}

// The classes of the nearest other samples, the nearest first.
std::vector<int> NearestClasses(const FeatureSet& features, const std::vector<int>& classes,
                                size_t sample, int neighbours) {
  std::vector<std::pair<double, size_t>> others;
  for (size_t i = 0; i < features.size(); ++i) {
    if (i != sample) others.emplace_back(SquaredDistance(features[sample], features[i]), i);
  }
  std::partial_sort(others.begin(), others.begin() + neighbours, others.end());
  std::vector<int> nearest;
  for (int i = 0; i < neighbours; ++i) {
    nearest.push_back(classes[others[static_cast<size_t>(i)].second]);
  }
  return nearest;
}

int Vote(const std::vector<int>& nearest) {
  std::map<int, int> votes;
  for (const int one : nearest) ++votes[one];
  int winner = nearest.front();
  for (const int one : nearest) {  // in this order: among equals the nearest wins
    if (votes[one] > votes[winner]) winner = one;
  }
  return winner;
}

absl::Status Check(const FeatureSet& features, const std::vector<int>& classes, int neighbours) {
  if (classes.size() != features.size()) {
    return absl::InvalidArgumentError(absl::StrCat("classes: expected one for each of ",
                                                   features.size(), " feature vectors, got ",
                                                   classes.size()));
  }
  if (features.size() < static_cast<size_t>(neighbours) + 1) {
    return absl::InvalidArgumentError(absl::StrCat("features: expected at least ", neighbours + 1,
                                                   " vectors, got ", features.size()));
  }
  for (const std::vector<float>& vector : features) {
    if (vector.size() == features.front().size()) continue;
    return absl::InvalidArgumentError(absl::StrCat("features: expected ", features.front().size(),
                                                   " values in each vector, as in the first, got ",
                                                   vector.size()));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<double> NeighbourAccuracy(const FeatureSet& features,
                                         const std::vector<int>& classes, int neighbours) {
  absl::Status status = Check(features, classes, neighbours);
  if (!status.ok()) return status;
  double right = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    if (Vote(NearestClasses(features, classes, i, neighbours)) == classes[i]) ++right;
  }
  return right / static_cast<double>(features.size());
}

}  // namespace duet::evaluation::metrics
