#include "model/cleanup/waist.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/cleanup/directions.h"
#include "model/cleanup/pair_line.h"
#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Pose = absl::Span<Vec3>;

// Fractions of the width between which the direction of narrow hips becomes certain.
constexpr float kUncertain = 0.3f, kCertain = 0.7f;

Vec3& At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

// The same within the ranges of the waist. Continuous in the line.
PairLine Limited(const PairLine& line, float width, const WaistOptions& options) {
  const float certain = SmoothStep((line.width / width - kUncertain) / (kCertain - kUncertain));
  PairLine limited;
  limited.turn = Within(options.twist, line.turn) * certain;
  limited.tilt = Within(options.tilt, line.tilt) * certain;
  limited.width = std::clamp(line.width, static_cast<float>(options.narrowest) * width,
                             static_cast<float>(options.widest) * width);
  return limited;
}

bool Same(const PairLine& a, const PairLine& b) {
  return a.turn == b.turn && a.tilt == b.tilt && a.width == b.width && a.reversed == b.reversed;
}

// Turns the hips of one pose, by a share of the correction.
class Waist {
 public:
  Waist(const motion::Skeleton& skeleton, const body::Body& body, int parent, float width,
        const WaistOptions& options)
      : hips_(*skeleton.hips), body_(body), parent_(parent), width_(width), options_(options) {}

  void Limit(float share, Pose pose) const {
    const Vec3 from = At(pose, parent_);
    TrunkAxes axes;
    if (!FindAxes(pose, &axes)) return;
    const PairLine line = Describe(axes, At(pose, hips_.left) - At(pose, hips_.right));
    const PairLine limited = Limited(line, width_, options_);
    if (line.width < kNoDirection || Same(line, limited)) return;
    const Vec3 middle = Lerp(At(pose, hips_.left), At(pose, hips_.right), 0.5f);
    const PlacedPair placed =
        PlacePair(axes, Shared(line, limited, share), from, middle - from,
                  Distance(from, At(pose, hips_.left)), Distance(from, At(pose, hips_.right)));
    MoveLegs(placed, pose);
  }

  // The direction of the hips to the left, seen along the trunk, in every frame.
  std::vector<Vec3> Directions(motion::Poses* poses) const {
    std::vector<Vec3> directions;
    directions.reserve(static_cast<std::size_t>(poses->frame_count()));
    for (int t = 0; t < poses->frame_count(); ++t) {
      const Pose pose = (*poses)[t];
      const Vec3 down = Down(pose);
      const Vec3 line = At(pose, hips_.left) - At(pose, hips_.right);
      const Vec3 across = line - down * Dot(line, down);
      const float length = Norm(across);
      const Vec3 before = directions.empty() ? Vec3{1, 0, 0} : directions.back();
      directions.push_back(length > kNoDirection ? across / length : before);
    }
    return directions;
  }

  // Turns the hips about the trunk.
  void Turn(Vec3 from, Vec3 to, Pose pose) const {
    if (from == to) return;
    const Vec3 pivot = At(pose, parent_), down = Down(pose);
    const float angle = SignedAngle(from, to, down);
    const auto turned = [&](int joint) {
      return pivot + RotateAbout(At(pose, joint) - pivot, down, angle);
    };
    MoveLegs({turned(hips_.left), turned(hips_.right)}, pose);
  }

 private:
  // From the chest to the middle of the hips, of length 1.
  Vec3 Down(Pose pose) const {
    const Vec3 down =
        Lerp(At(pose, hips_.left), At(pose, hips_.right), 0.5f) - At(pose, *body_.chest);
    const float length = Norm(down);
    return length > kNoDirection ? down / length : Vec3{0, -1, 0};
  }

  bool FindAxes(Pose pose, TrunkAxes* axes) const {
    const Vec3 middle = Lerp(At(pose, hips_.left), At(pose, hips_.right), 0.5f);
    // The trunk's direction: the parent may be close to the middle of the hips.
    const Vec3 down = middle - At(pose, *body_.chest);
    const Vec3 shoulders = At(pose, body_.shoulders->left) - At(pose, body_.shoulders->right);
    const Vec3 behind = Cross(shoulders, down);
    if (Norm(down) < kNoDirection || Norm(behind) < kNoDirection * Norm(down)) return false;
    axes->down = down / Norm(down);
    axes->behind = behind / Norm(behind);
    axes->left = Cross(axes->down, axes->behind);
    return true;
  }

  static PairLine Shared(const PairLine& from, const PairLine& to, float share) {
    PairLine line = to;
    // A reversed line turns the short way.
    const float turn = from.reversed ? std::copysign(180.0f, from.turn) - from.turn : from.turn;
    line.turn = turn + (to.turn - turn) * share;
    line.tilt = from.tilt + (to.tilt - from.tilt) * share;
    line.width = from.width + (to.width - from.width) * share;
    return line;
  }

  void MoveLegs(const PlacedPair& hips, Pose pose) const {
    const Vec3 from[] = {At(pose, hips_.left), At(pose, hips_.right)};
    At(pose, hips_.left) = hips.left;
    At(pose, hips_.right) = hips.right;
    const Vec3 forward = body::Facing(hips_, pose);
    for (const body::Limb& leg : body_.legs) {
      if (leg.upper != hips_.left && leg.upper != hips_.right) continue;
      const Vec3 moved = At(pose, leg.upper) - (leg.upper == hips_.left ? from[0] : from[1]);
      const Vec3 foot = At(pose, leg.end);
      for (const int joint : {leg.middle, leg.end}) At(pose, joint) += moved;
      for (const int joint : leg.beyond) At(pose, joint) += moved;
      Reach(leg, foot, forward, pose);
    }
  }

  const motion::JointPair hips_;
  const body::Body& body_;
  const int parent_;
  const float width_;
  const WaistOptions& options_;
};

}  // namespace

void LimitWaist(const motion::Skeleton& skeleton, const body::Body& body,
                const motion::Poses& leader, const WaistOptions& options, const Timing& timing,
                motion::Poses* poses) {
  if (!skeleton.hips || !body.chest || !body.shoulders || body.legs.empty()) return;
  const std::vector<int> parents = skeleton.Parents();
  const int parent = parents[static_cast<std::size_t>(skeleton.hips->left)];
  if (parent < 0 || parent != parents[static_cast<std::size_t>(skeleton.hips->right)]) return;
  const float width = timing.settled > 0
                          ? MedianWidth(*skeleton.hips, *poses, timing.settled)
                          : MedianWidth(*skeleton.hips, leader, leader.frame_count());
  if (width < kNoDirection) return;
  const Waist waist(skeleton, body, parent, width, options);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    waist.Limit(EaseIn(timing, t), (*poses)[t]);
  }
  const std::vector<Vec3> before = waist.Directions(poses);
  std::vector<Vec3> after = before;
  LimitTurns(timing.settled, MostInAFrame(options.fastest_turn, timing), &after);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    waist.Turn(before[at], after[at], (*poses)[t]);
  }
}

}  // namespace duet::cleanup
