#include "model/body/posture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "model/base/angle.h"

namespace duet::body {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

motion::Vec3 Middle(const motion::Poses& poses, int frame, const motion::JointPair& pair) {
  return Lerp(poses.at(frame, pair.left), poses.at(frame, pair.right), 0.5f);
}

std::optional<motion::JointPair> Shoulders(const motion::Skeleton& skeleton) {
  const motion::JointPair pair = {skeleton.Find("left_shoulder"), skeleton.Find("right_shoulder")};
  if (pair.left < 0 || pair.right < 0) return std::nullopt;
  return pair;
}

// The unit vector from left to right; nullopt without such a pair.
motion::Vec3 Across(const motion::Poses& poses, int frame,
                    const std::optional<motion::JointPair>& pair) {
  if (!pair) return {};
  const motion::Vec3 across = poses.at(frame, pair->right) - poses.at(frame, pair->left);
  const float length = Norm(across);
  return length == 0 ? motion::Vec3{} : across / length;
}

// Seen from above; 0 for a vector of length 0.
double HorizontalAngle(motion::Vec3 a, motion::Vec3 b) {
  a.y = b.y = 0;
  return std::atan2(Norm(Cross(a, b)), Dot(a, b)) * base::kDegreesPerRadian;
}

double LargestMean(const std::vector<double>& values, size_t window) {
  window = std::clamp<size_t>(window, 1, values.size());
  double sum = 0, largest = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    sum += values[i];
    if (i >= window) sum -= values[i - window];
    if (i + 1 >= window) largest = std::max(largest, sum / static_cast<double>(window));
  }
  return largest;
}

}  // namespace

Lean MeasureLean(const motion::Poses& poses, const motion::Skeleton& skeleton, double frame_rate_hz,
                 LeanFrom from) {
  const auto& base = from == LeanFrom::kHips ? skeleton.hips : skeleton.feet;
  const int neck = skeleton.Find("neck"), top = neck >= 0 ? neck : skeleton.Find("head");
  if (!base || top < 0) return {kNone, kNone};
  std::vector<double> angles;
  double sum = 0;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const motion::Vec3 up = poses.at(t, top) - Middle(poses, t, *base);
    angles.push_back(std::atan2(std::hypot(up.x, up.z), up.y) * base::kDegreesPerRadian);
    sum += angles.back();
  }
  return {sum / poses.frame_count(),
          LargestMean(angles, static_cast<size_t>(std::lround(frame_rate_hz)))};
}

double FacingDegrees(const motion::Poses& leader, const motion::Poses& follower,
                     const motion::Skeleton& skeleton) {
  const std::optional<motion::JointPair> shoulders = Shoulders(skeleton);
  if (!skeleton.hips && !shoulders) return kNone;
  double sum = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 across = Across(follower, t, skeleton.hips) + Across(follower, t, shoulders);
    const motion::Vec3 facing = Cross({0, 1, 0}, across);
    sum += HorizontalAngle(facing, leader.at(t, skeleton.root) - follower.at(t, skeleton.root));
  }
  return sum / follower.frame_count();
}

double RootDistance(const motion::Poses& leader, const motion::Poses& follower,
                    const motion::Skeleton& skeleton) {
  double sum = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 apart = follower.at(t, skeleton.root) - leader.at(t, skeleton.root);
    sum += std::hypot(apart.x, apart.z);
  }
  return sum / follower.frame_count();
}

FloorGap MeasureFloorGap(const motion::Poses& poses, const motion::Skeleton& skeleton,
                         double floor) {
  if (!skeleton.feet) return {kNone, kNone, kNone};
  FloorGap gap;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const double lower =
        std::min(poses.at(t, skeleton.feet->left).y, poses.at(t, skeleton.feet->right).y) - floor;
    gap.above = std::max(gap.above, lower);
    gap.below = std::max(gap.below, -lower);
    gap.mean += std::abs(lower) / poses.frame_count();
  }
  return gap;
}

}  // namespace duet::body
