#include "model/engine/direction_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "model/motion/standardise.h"

namespace duet::engine {
namespace {

constexpr double kMostDeviations = 3;

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

std::vector<double> ScaledFeatures(const DirectionRegression& regression,
                                   std::vector<double> features) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    features[i] = std::clamp((features[i] - regression.mean[i]) / regression.deviation[i],
                             -kMostDeviations, kMostDeviations);
  }
  return features;
}

std::optional<motion::Vec3> EstimatePartnerDirection(const DirectionRegression& regression,
                                                     const motion::Skeleton& skeleton,
                                                     const motion::Poses& leader) {
  std::optional<std::vector<double>> features = DirectionFeatures(skeleton, leader);
  if (!features) return std::nullopt;
  const std::vector<double> scaled = ScaledFeatures(regression, *std::move(features));
  const double angle =
      std::atan2(Product(regression.sine, scaled), Product(regression.cosine, scaled));
  const motion::Vec3 seen = {static_cast<float>(std::sin(angle)), 0,
                             static_cast<float>(-std::cos(angle))};
  return RotateY(seen, -HipFrame(skeleton, leader).yaw());
}

}  // namespace duet::engine
