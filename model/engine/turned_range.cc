#include "model/engine/turned_range.h"

#include <algorithm>
#include <cmath>

#include "model/base/angle.h"

namespace duet::engine {
namespace {

// The direction of a person's hips against the line to the partner, degrees; jumps by whole turns.
double Direction(const motion::JointPair& hips, int root, const motion::Poses& person,
                 const motion::Poses& partner, int frame) {
  const motion::Vec3 across = person.at(frame, hips.left) - person.at(frame, hips.right);
  const motion::Vec3 line = partner.at(frame, root) - person.at(frame, root);
  return (std::atan2(across.z, across.x) - std::atan2(line.z, line.x)) / base::kRadiansPerDegree;
}

}  // namespace

double TurnedAt(const motion::JointPair& hips, int root, const motion::Poses& person,
                const motion::Poses& partner, int frame) {
  const double turned = Direction(hips, root, person, partner, frame) -
                        Direction(hips, root, person, partner, frame - 1);
  return turned - 360 * std::round(turned / 360);
}

void TurnedRange::Add(double degrees) {
  at_ += degrees;
  lowest_ = std::min(lowest_, at_);
  highest_ = std::max(highest_, at_);
  forwards_ = std::max(forwards_, at_ - lowest_);
  backwards_ = std::max(backwards_, highest_ - at_);
}

}  // namespace duet::engine
