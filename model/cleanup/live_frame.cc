#include "model/cleanup/live_frame.h"

#include <algorithm>
#include <cstddef>

#include "model/cleanup/directions.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kNearestMetres = 0.17f;

}  // namespace

void PlaceFeetBetween(const motion::Skeleton& skeleton, const body::Body& body,
                      absl::Span<const Vec3> before, absl::Span<const Vec3> after,
                      absl::Span<const Vec3> interpolated, absl::Span<Vec3> pose) {
  if (!skeleton.hips) return;
  const Vec3 facing = body::Facing(*skeleton.hips, pose);
  for (const body::Limb& leg : body.legs) {
    const std::size_t foot = static_cast<std::size_t>(leg.end);
    Vec3 place = interpolated[foot];
    const auto [low, high] = std::minmax(before[foot].y, after[foot].y);
    place.y = std::clamp(place.y, low, high);
    Reach(leg, place, facing, pose);
  }
}

float HeightOf(const body::Body& body, absl::Span<const Vec3> pose) {
  if (body.legs.size() != 2) return 0;
  const auto height = [&](const body::Limb& leg) {
    return pose[static_cast<std::size_t>(leg.end)].y;
  };
  return std::min(height(body.legs[0]), height(body.legs[1]));
}

void KeepHeight(const body::Body& body, float height, absl::Span<Vec3> pose) {
  const float lift = height - HeightOf(body, pose);
  if (body.legs.size() != 2 || lift == 0) return;
  for (Vec3& joint : pose) joint.y += lift;
}

void KeepApart(int root, absl::Span<const Vec3> leader, absl::Span<Vec3> follower) {
  const std::size_t at = static_cast<std::size_t>(root);
  const Vec3 offset = Level(follower[at] - leader[at]);
  const float distance = Norm(offset);
  if (distance >= kNearestMetres) return;
  const Vec3 direction = distance > kNoOffset ? offset / distance : Vec3{0, 0, 1};
  const Vec3 shift = direction * kNearestMetres - offset;
  for (Vec3& joint : follower) joint += shift;
}

}  // namespace duet::cleanup
