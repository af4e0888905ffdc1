#include "model/cleanup/joint_ranges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kRadiansPerDegree = 0.01745329252f;
// Metres, radians or a sine. Less counts as nothing.
constexpr float kNothing = 1e-5f;
// Degrees by which an arm at rest points forwards of straight down: half the difference between the
// outward and inward rotation of shoulders.
constexpr float kArmRestDegrees = 17.5f;
constexpr float kNoFloor = -std::numeric_limits<float>::infinity();
// Metres by which correcting a knee may move the foot below the floor: less than in captures.
constexpr float kSink = 0.03f;
// Bisection steps that find how far a leg may straighten, to a thousandth.
constexpr int kHalvings = 10;
// Cosines of 110 and 150 degrees from rest, between which the reference of a limb fades out.
constexpr float kFadesFrom = -0.342f, kFadesTo = -0.866f;

float Float(double value) { return static_cast<float>(value); }

float Within(const SoftRange& range, float degrees, float slack = 0) {
  return SoftLimit(degrees, Float(range.free) + slack, Float(range.most) + slack);
}

// Orthonormal directions of a body.
struct Axes {
  Vec3 up, forward;
};

// `across` points to the body's left.
std::optional<Axes> AxesOf(Vec3 trunk, Vec3 across) {
  const Vec3 forward = Cross(across, trunk);
  const float height = Norm(trunk), area = Norm(forward);
  if (height < kNothing || area < kNothing * height) return std::nullopt;
  return Axes{trunk / height, forward / area};
}

// The directions in which a limb hangs and bends at rest, and its range of rotation about itself.
struct Hinge {
  Vec3 rest, bend;
  float turn_degrees = 0;
};

Hinge KneeOf(const Axes& axes, const JointRangeOptions& options) {
  return {-axes.up, -axes.forward, Float(options.leg_turn)};
}

Hinge ElbowOf(const Axes& axes, const JointRangeOptions& options) {
  const float c = std::cos(kArmRestDegrees * kRadiansPerDegree);
  const float s = std::sin(kArmRestDegrees * kRadiansPerDegree);
  return {axes.forward * s - axes.up * c, axes.forward * c + axes.up * s, Float(options.arm_turn)};
}

// Rotates `v` by the shortest arc from `from` to `to`, both of length 1 and not opposite.
Vec3 Swing(Vec3 from, Vec3 to, Vec3 v) {
  const Vec3 axis = Cross(from, to);
  const float cosine = Dot(from, to);
  return v * cosine + Cross(axis, v) + axis * (Dot(axis, v) / (1 + cosine));
}

// The bend of a limb in degrees: `ahead` in its natural direction, `aside` perpendicular to it;
// (0, 0) is straight.
struct Bend {
  float ahead = 0, aside = 0;
};

Bend Limited(Bend bend, float turn_degrees, const JointRangeOptions& options) {
  const float angle = std::hypot(bend.ahead, bend.aside);
  const float kept = Within(options.folded, angle) / angle;
  bend = {bend.ahead * kept, bend.aside * kept};
  const bool turns_beyond = turn_degrees > 90;
  const float slope =
      std::tan((turns_beyond ? turn_degrees - 90 : turn_degrees) * kRadiansPerDegree);
  const float slack = turns_beyond ? std::abs(bend.aside) * slope : 0;
  bend.ahead = -Within(options.backwards, -bend.ahead, slack);
  if (turns_beyond) return bend;
  const float aside =
      Within(options.knee_aside, std::abs(bend.aside), std::max(0.0f, bend.ahead) * slope);
  bend.aside = std::copysign(aside, bend.aside);
  return bend;
}

// The weight of the correction of a limb whose direction has this cosine with its rest direction.
float Certainty(float cosine) { return SmoothStep((cosine - kFadesTo) / (kFadesFrom - kFadesTo)); }

// What the direction of an outer bone is corrected by; the part that applies is chosen last,
// because a leg may try several.
struct DirectionFix {
  Vec3 inner, ahead, aside;  // orthonormal
  Bend bend, limited;
  float certainty = 0;

  // The corrected direction of the outer bone, of length 1.
  Vec3 At(float share) const {
    share *= certainty;
    const Bend now{bend.ahead + (limited.ahead - bend.ahead) * share,
                   bend.aside + (limited.aside - bend.aside) * share};
    const float angle = std::hypot(now.ahead, now.aside);
    if (angle < kNothing) return inner;
    const Vec3 way = (ahead * now.ahead + aside * now.aside) / angle;
    return inner * std::cos(angle * kRadiansPerDegree) + way * std::sin(angle * kRadiansPerDegree);
  }
};

// Absent if the outer bone is within its range. `inner` and `outer` have length 1.
std::optional<DirectionFix> FindFix(Vec3 inner, Vec3 outer, const Hinge& hinge,
                                    const JointRangeOptions& options) {
  const float certainty = Certainty(Dot(hinge.rest, inner));
  const float cosine = Dot(inner, outer);
  const Vec3 across = outer - inner * cosine;
  const float sine = Norm(across);
  if (certainty == 0 || sine < kNothing) return std::nullopt;
  const Vec3 ahead = Swing(hinge.rest, inner, hinge.bend), aside = Cross(inner, ahead);
  const float degrees = std::atan2(sine, cosine) / kRadiansPerDegree;
  const Bend bend{Dot(across, ahead) / sine * degrees, Dot(across, aside) / sine * degrees};
  const Bend limited = Limited(bend, hinge.turn_degrees, options);
  if (limited.ahead == bend.ahead && limited.aside == bend.aside) return std::nullopt;
  return DirectionFix{inner, ahead, aside, bend, limited, certainty};
}

// The corrected positions of a limb's middle and end.
struct Placed {
  Vec3 middle, end;
};

// Limits the bend of a limb, then rotates the limb so that its end keeps its direction from the
// upper joint.
class LimbFix {
 public:
  // Absent if the limb is within its range.
  static std::optional<LimbFix> Find(Vec3 upper, Vec3 middle, Vec3 end, const Hinge& hinge,
                                     const JointRangeOptions& options) {
    const float thigh = Distance(upper, middle), shin = Distance(middle, end);
    const float reach = Distance(upper, end);
    if (std::min({thigh, shin, reach}) < kNothing) return std::nullopt;
    const Vec3 outer = (end - middle) / shin;
    const auto direction = FindFix((middle - upper) / thigh, outer, hinge, options);
    if (!direction) return std::nullopt;
    return LimbFix(upper, outer, (end - upper) / reach, thigh, shin, *direction);
  }

  // Absent if this share of the correction moves nothing.
  std::optional<Placed> Place(float share) const {
    if (share == 0) return std::nullopt;
    const Vec3 right = direction_.At(share);
    if (right == outer_) return std::nullopt;
    const Vec3 bent = direction_.inner * thigh_ + right * shin_;
    const float reach = Norm(bent);
    if (reach < kNothing) return std::nullopt;
    return Placed{upper_ + Swing(bent / reach, to_, direction_.inner) * thigh_,
                  upper_ + to_ * reach};
  }

 private:
  LimbFix(Vec3 upper, Vec3 outer, Vec3 to, float thigh, float shin, const DirectionFix& direction)
      : upper_(upper), outer_(outer), to_(to), thigh_(thigh), shin_(shin), direction_(direction) {}

  Vec3 upper_, outer_, to_;
  float thigh_, shin_;
  DirectionFix direction_;
};

// Reduces the correction of a leg, which reaches farther when it straightens, so that its end is
// not below `lowest`.
std::optional<Placed> PlaceAbove(float lowest, const LimbFix& fix, float share) {
  std::optional<Placed> placed = fix.Place(share);
  if (!placed.has_value() || placed->end.y >= lowest) return placed;
  placed.reset();
  float above = 0, below = share;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const float tried = (above + below) / 2;
    const auto next = fix.Place(tried);
    const bool stays = !next.has_value() || next->end.y >= lowest;
    (stays ? above : below) = tried;
    if (stays) placed = next;
  }
  return placed;
}

// Returns whether a joint moved.
bool LimitLimb(const body::Limb& limb, float floor, const Hinge& hinge,
               const JointRangeOptions& options, float share, absl::Span<Vec3> pose) {
  Vec3& middle = pose[static_cast<std::size_t>(limb.middle)];
  Vec3& end = pose[static_cast<std::size_t>(limb.end)];
  const auto fix =
      LimbFix::Find(pose[static_cast<std::size_t>(limb.upper)], middle, end, hinge, options);
  if (!fix.has_value()) return false;
  const auto placed = PlaceAbove(std::min(floor - kSink, end.y), *fix, share);
  if (!placed.has_value()) return false;
  const Vec3 moved = placed->end - end;
  for (const int joint : limb.beyond) pose[static_cast<std::size_t>(joint)] += moved;
  middle = placed->middle;
  end = placed->end;
  return true;
}

// Rotating a limb changes its reference; after the second pass little remains.
void LimitLimbs(const std::vector<body::Limb>& limbs, float floor, const Hinge& hinge,
                const JointRangeOptions& options, float share, absl::Span<Vec3> pose) {
  for (const body::Limb& limb : limbs) {
    if (LimitLimb(limb, floor, hinge, options, share, pose)) {
      LimitLimb(limb, floor, hinge, options, share, pose);
    }
  }
}

void LimitNeck(const body::Neck& neck, Vec3 up, const JointRangeOptions& options, float share,
               absl::Span<Vec3> pose) {
  const Vec3 base = pose[static_cast<std::size_t>(neck.base)];
  const Vec3 head = pose[static_cast<std::size_t>(neck.head)] - base;
  const Vec3 axis = Cross(head, up);
  const float sine = Norm(axis);
  const float degrees = std::atan2(sine, Dot(head, up)) / kRadiansPerDegree;
  const float excess = degrees - Within(options.neck, degrees);
  if (excess <= 0 || sine < kNothing) return;
  for (const int joint : neck.branch) {
    Vec3& position = pose[static_cast<std::size_t>(joint)];
    position = base + RotateAbout(position - base, axis / sine, excess * share * kRadiansPerDegree);
  }
}

// The vector from the right shoulder to the left one in every frame. The hips over all frames
// determine which arm is the left one. Shapes: returns [frames].
std::vector<Vec3> ShouldersToTheLeft(const motion::JointPair& hips,
                                     const std::vector<body::Limb>& arms,
                                     const motion::Poses& poses) {
  std::vector<Vec3> across;
  float agreement = 0;
  for (int t = 0; t < poses.frame_count(); ++t) {
    across.push_back(poses.at(t, arms[0].upper) - poses.at(t, arms[1].upper));
    agreement += Dot(across.back(), poses.at(t, hips.left) - poses.at(t, hips.right));
  }
  if (agreement < 0) {
    for (Vec3& way : across) way = -way;
  }
  return across;
}

}  // namespace

void KeepJointRanges(const motion::Skeleton& skeleton, const body::Body& body,
                     std::optional<float> floor, const JointRangeOptions& options,
                     const Timing& timing, motion::Poses* poses) {
  if (!skeleton.hips || !body.chest) return;
  std::vector<Vec3> shoulders;
  if (body.arms.size() == 2) shoulders = ShouldersToTheLeft(*skeleton.hips, body.arms, *poses);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const float share = EaseIn(timing, t);
    const Vec3 left = poses->at(t, skeleton.hips->left), right = poses->at(t, skeleton.hips->right);
    const Vec3 trunk = poses->at(t, *body.chest) - Lerp(left, right, 0.5f);
    const absl::Span<Vec3> pose = (*poses)[t];
    if (const auto axes = AxesOf(trunk, left - right)) {
      LimitLimbs(body.legs, floor.value_or(kNoFloor), KneeOf(*axes, options), options, share, pose);
      if (body.neck) LimitNeck(*body.neck, axes->up, options, share, pose);
    }
    if (shoulders.empty()) continue;
    if (const auto axes = AxesOf(trunk, shoulders[static_cast<std::size_t>(t)])) {
      LimitLimbs(body.arms, kNoFloor, ElbowOf(*axes, options), options, share, pose);
    }
  }
}

}  // namespace duet::cleanup
