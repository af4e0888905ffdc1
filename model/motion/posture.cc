#include "model/motion/posture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/base/angle.h"
#include "model/base/median.h"

namespace duet::motion {
namespace {

// Distance up to which points have full weight, times the median one.
constexpr double kMeanReach = 2;
constexpr double kSmallestReach = 1e-4;  // if all points coincide
constexpr int kMeanSteps = 30;

Vec3 Mean(const std::vector<Vec3>& points, const std::vector<double>& weights) {
  double x = 0, y = 0, z = 0, sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    x += weights[i] * points[i].x;
    y += weights[i] * points[i].y;
    z += weights[i] * points[i].z;
    sum += weights[i];
  }
  return {static_cast<float>(x / sum), static_cast<float>(y / sum), static_cast<float>(z / sum)};
}

// 1 for residuals up to kMeanReach times the median one, falling in proportion beyond.
std::vector<double> HuberWeights(std::vector<double> residuals) {
  const double full = std::max(kMeanReach * base::Median(residuals), kSmallestReach);
  for (double& residual : residuals) residual = residual > full ? full / residual : 1;
  return residuals;
}

// From the middle of the feet to the neck; to the root if the skeleton has no joint "neck".
// Requires feet.
Vec3 FromFeet(const Skeleton& skeleton, const Poses& poses, int frame) {
  const int neck = skeleton.Find("neck");
  const int top = neck < 0 ? skeleton.root : neck;
  return poses.at(frame, top) -
         (poses.at(frame, skeleton.feet->left) + poses.at(frame, skeleton.feet->right)) / 2;
}

}  // namespace

std::vector<Vec3> StandingDirections(const Skeleton& skeleton, const Poses& poses) {
  std::vector<Vec3> directions;
  if (!skeleton.feet) return directions;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 body = FromFeet(skeleton, poses, t);
    const float length = Norm(body);
    if (length > 0) directions.push_back(body / length);
  }
  return directions;
}

std::vector<Vec3> LowerFeet(const Skeleton& skeleton, const Poses& poses) {
  std::vector<Vec3> feet;
  if (!skeleton.feet) return feet;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3& left = poses.at(t, skeleton.feet->left);
    const Vec3& right = poses.at(t, skeleton.feet->right);
    feet.push_back(left.y < right.y ? left : right);
  }
  return feet;
}

Vec3 RobustMean(const std::vector<Vec3>& points) {
  if (points.empty()) return {};
  std::vector<double> weights(points.size(), 1);
  Vec3 mean;
  for (int step = 0; step < kMeanSteps; ++step) {
    mean = Mean(points, weights);
    for (std::size_t i = 0; i < points.size(); ++i) weights[i] = Distance(points[i], mean);
    weights = HuberWeights(std::move(weights));
  }
  return mean;
}

Lean LeanOf(Vec3 up) {
  return {std::atan2(up.x, up.y) * base::kDegreesPerRadian,
          std::atan2(up.z, up.y) * base::kDegreesPerRadian};
}

Lean MeanLean(const std::vector<Vec3>& directions) {
  if (directions.empty()) return {};
  return LeanOf(Mean(directions, std::vector<double>(directions.size(), 1)));
}

float HeightQuantile(const std::vector<Vec3>& points, double share) {
  std::vector<float> heights;
  heights.reserve(points.size());
  for (const Vec3& point : points) heights.push_back(point.y);
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(heights.size() - 1));
  std::nth_element(heights.begin(), heights.begin() + rank, heights.end());
  return heights[static_cast<std::size_t>(rank)];
}

}  // namespace duet::motion
