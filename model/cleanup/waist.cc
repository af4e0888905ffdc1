#include "model/cleanup/waist.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/base/median.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Pose = absl::Span<Vec3>;

constexpr float kDegree = 0.01745329252f;
// Metres. A shorter vector has no direction.
constexpr float kNoDirection = 1e-4f;
// Fractions of the width between which the direction of narrow hips becomes certain.
constexpr float kUncertain = 0.3f, kCertain = 0.7f;

Vec3& At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

float Within(const SoftRange& range, float degrees) {
  const float limited =
      SoftLimit(std::abs(degrees), static_cast<float>(range.free), static_cast<float>(range.most));
  return std::copysign(limited, degrees);
}

float MedianWidth(const motion::JointPair& hips, const motion::Poses& poses, int frames) {
  std::vector<float> widths;
  for (int t = 0; t < frames; ++t) {
    widths.push_back(Distance(poses.at(t, hips.left), poses.at(t, hips.right)));
  }
  return base::Median(std::move(widths));
}

// The directions of a trunk: orthonormal.
struct Axes {
  Vec3 down;    // from the chest to the middle of the hips
  Vec3 left;    // of the shoulders
  Vec3 behind;  // such that a positive angle from left towards it is a turn of the hips to the left
};

// The line of the hips in these axes, to the left.
struct HipLine {
  float turn = 0;   // degrees from the shoulders' line, to the left; -90 to 90 with mirrored ones
  float tilt = 0;   // degrees downwards on the left
  float width = 0;  // metres
  bool reversed = false;
};

HipLine Describe(const Axes& axes, Vec3 across) {
  const float left = Dot(across, axes.left), behind = Dot(across, axes.behind);
  HipLine line;
  line.reversed = left < 0;
  line.turn = std::atan2(behind, std::abs(left)) / kDegree;
  line.width = Norm(across);
  line.tilt = std::asin(std::clamp(Dot(across, axes.down) / line.width, -1.0f, 1.0f)) / kDegree;
  return line;
}

// The same within the ranges of the waist. Continuous in the line.
HipLine Limited(const HipLine& line, float width, const WaistOptions& options) {
  const float certain = SmoothStep((line.width / width - kUncertain) / (kCertain - kUncertain));
  HipLine limited;
  limited.turn = Within(options.twist, line.turn) * certain;
  limited.tilt = Within(options.tilt, line.tilt) * certain;
  limited.width = std::clamp(line.width, static_cast<float>(options.narrowest) * width,
                             static_cast<float>(options.widest) * width);
  return limited;
}

bool Same(const HipLine& a, const HipLine& b) {
  return a.turn == b.turn && a.tilt == b.tilt && a.width == b.width && a.reversed == b.reversed;
}

struct Hips {
  Vec3 left, right;
};

// The hips on a line, at their distances `to_left` and `to_right` from their parent at `from`, in
// the direction `towards`.
Hips PlaceHips(const Axes& axes, const HipLine& line, Vec3 from, Vec3 towards, float to_left,
               float to_right) {
  const float c = std::cos(line.turn * kDegree), s = std::sin(line.turn * kDegree);
  const Vec3 level = axes.left * c + axes.behind * s;
  const float ct = std::cos(line.tilt * kDegree), st = std::sin(line.tilt * kDegree);
  const Vec3 along = level * ct + axes.down * st;
  const Vec3 across = towards - along * Dot(towards, along);
  const Vec3 down =
      Norm(across) > kNoDirection ? across / Norm(across) : axes.down * ct - level * st;
  // A triangle with these three sides, as wide as the bones allow.
  const float width = std::clamp(line.width, std::abs(to_left - to_right), to_left + to_right);
  if (width < kNoDirection) return {from + down * to_left, from + down * to_right};
  const float a = (to_left * to_left - to_right * to_right + width * width) / (2 * width);
  const float depth = std::sqrt(std::max(0.0f, to_left * to_left - a * a));
  const Vec3 left = from + down * depth + along * a;
  return {left, left - along * width};
}

// Turns the hips of one pose, by a share of the correction.
class Waist {
 public:
  Waist(const motion::Skeleton& skeleton, const body::Body& body, int parent, float width,
        const WaistOptions& options)
      : hips_(*skeleton.hips), body_(body), parent_(parent), width_(width), options_(options) {}

  void Limit(float share, Pose pose) const {
    const Vec3 from = At(pose, parent_);
    Axes axes;
    if (!FindAxes(pose, &axes)) return;
    const HipLine line = Describe(axes, At(pose, hips_.left) - At(pose, hips_.right));
    const HipLine limited = Limited(line, width_, options_);
    if (line.width < kNoDirection || Same(line, limited)) return;
    const Vec3 middle = Lerp(At(pose, hips_.left), At(pose, hips_.right), 0.5f);
    const Hips placed =
        PlaceHips(axes, Shared(line, limited, share), from, middle - from,
                  Distance(from, At(pose, hips_.left)), Distance(from, At(pose, hips_.right)));
    MoveLegs(placed, pose);
  }

 private:
  bool FindAxes(Pose pose, Axes* axes) const {
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

  static HipLine Shared(const HipLine& from, const HipLine& to, float share) {
    HipLine line = to;
    // A reversed line turns the short way.
    const float turn = from.reversed ? std::copysign(180.0f, from.turn) - from.turn : from.turn;
    line.turn = turn + (to.turn - turn) * share;
    line.tilt = from.tilt + (to.tilt - from.tilt) * share;
    line.width = from.width + (to.width - from.width) * share;
    return line;
  }

  void MoveLegs(const Hips& hips, Pose pose) const {
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
}

}  // namespace duet::cleanup
