#include "client/cli/skeleton_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/base/index.h"
#include "model/base/median.h"
#include "model/body/limbs.h"
#include "model/motion/feet.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/posture.h"

namespace duet::client::cli {
namespace {

using motion::Vec3;

// Standard deviation of a bone's length divided by its mean; up to 0.1 for Kinect's bones.
constexpr double kMostDrift = 0.1;
// Rounding errors, in any unit.
constexpr double kLeastLength = 1e-6;
// Length of a left bone divided by the right one, or vice versa.
constexpr double kMostAsymmetry = 1.15;
constexpr double kMostBelowFloor = 0.1, kHighAboveFloor = 0.15, kMostTimeInTheAir = 0.25;
// A fist in boxing reaches 11 m/s, a kicking foot 16.
constexpr double kFastestJoint = 20, kFastestRoot = 10;
// Joints that swap places are at least this far apart.
constexpr float kLeastSwap = 0.15f;
// A knee or an elbow counts as bent if it is this far off the line between the limb's ends. If more
// than this share of the bending is in the wrong direction, it is not noise.
constexpr float kLeastBend = 0.04f;
constexpr double kMostBentWrongly = 0.8;

// Maximum lean of the mean standing direction in degrees. People lean forwards for a long time, but
// rarely backwards or sideways. The tilt of a camera does not depend on the facing direction.
constexpr double kMostForwardLean = 12, kMostOtherLean = 5;
// Rotation of the shoulders against the hips in degrees. People reach 50, and more for a moment.
constexpr double kMostTwist = 60, kMostTimeTwisted = 0.02;

using base::Index;

std::string Percent(double share) { return absl::StrFormat("%.1f %%", 100 * share); }

std::string BoneName(const motion::Skeleton& skeleton, std::size_t bone) {
  return absl::StrCat(skeleton.joint_names[Index(skeleton.bones[bone].parent)], " to ",
                      skeleton.joint_names[Index(skeleton.bones[bone].child)]);
}

class Checker {
 public:
  Checker(const motion::Clip& clip, const motion::Skeleton& skeleton)
      : clip_(clip), skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

  std::vector<SkeletonCheck> Run() {
    CheckFinite();
    if (!checks_.back().good) return std::move(checks_);
    CheckSize();
    CheckLimbLengths();
    CheckSymmetry();
    CheckFloor();
    CheckJumps();
    CheckSides();
    CheckUpright();
    CheckWaist();
    return std::move(checks_);
  }

 private:
  void Add(std::string name, bool good, std::string text, std::map<std::string, double> figures) {
    checks_.push_back({std::move(name), good, std::move(text), std::move(figures)});
  }

  void CheckFinite() {
    int bad = 0, first = 0;
    for (int frame = clip_.frame_count() - 1; frame >= 0; --frame) {
      const absl::Span<const Vec3> pose = clip_.poses[frame];
      if (std::all_of(pose.begin(), pose.end(), [](Vec3 at) { return IsFinite(at); })) continue;
      ++bad;
      first = frame;
    }
    Add("finite", bad == 0,
        bad == 0 ? "every position is a finite number"
                 : absl::StrCat("a position is not finite in ", bad, " frames, first in ", first),
        {{"bad_frames", bad}});
  }

  void CheckSize() {
    if (!skeleton_.feet) return;
    const double leg = motion::LegLength(skeleton_, clip_.poses);
    const bool good = motion::IsLegLength(leg);
    Add("size", good,
        absl::StrFormat("foot to %s %.2f m%s", skeleton_.joint_names[Index(skeleton_.root)], leg,
                        good ? ""
                             : absl::StrFormat(", expected %.1f to %.1f m. Check the unit",
                                               motion::kShortestLeg, motion::kLongestLeg)),
        {{"foot_to_root_metres", leg}});
  }

  double Drift(const motion::Bone& bone) const {
    double sum = 0, squares = 0;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      const double length =
          static_cast<double>(Distance(clip_.at(frame, bone.parent), clip_.at(frame, bone.child)));
      sum += length;
      squares += length * length;
    }
    const double mean = sum / clip_.frame_count();
    if (!(mean > 0)) return 0;
    return std::sqrt(std::max(0.0, squares / clip_.frame_count() - mean * mean)) / mean;
  }

  // The first bone whose joints always coincide; empty if there is none.
  std::string BoneWithoutLength() const {
    for (std::size_t bone = 0; bone < skeleton_.bones.size(); ++bone) {
      if (MedianLength(skeleton_.bones[bone]) < kLeastLength) return BoneName(skeleton_, bone);
    }
    return "";
  }

  void CheckLimbLengths() {
    double mean = 0, most = 0;
    std::size_t worst = 0;
    for (std::size_t bone = 0; bone < skeleton_.bones.size(); ++bone) {
      const double drift = Drift(skeleton_.bones[bone]);
      mean += drift / static_cast<double>(skeleton_.bones.size());
      if (drift <= most) continue;
      most = drift;
      worst = bone;
    }
    std::string text = absl::StrCat("change by ", Percent(mean));
    if (most > 0)
      absl::StrAppend(&text, ", most ", BoneName(skeleton_, worst), ", ", Percent(most));
    const std::string none = BoneWithoutLength();
    if (!none.empty()) absl::StrAppend(&text, "; ", none, " has no length");
    Add("limb lengths", most <= kMostDrift && none.empty(), text,
        {{"mean_change", mean}, {"most_change", most}});
  }

  // The limbs of a pair may be left and right, or right and left.
  void CheckSymmetry() {
    double most = 1;
    std::string worst;
    for (const std::vector<body::Limb>* limbs : {&body_.arms, &body_.legs}) {
      if (limbs->size() != 2) continue;
      const body::Limb &a = (*limbs)[0], &b = (*limbs)[1];
      Compare({a.upper, a.middle}, {b.upper, b.middle}, &most, &worst);
      Compare({a.middle, a.end}, {b.middle, b.end}, &most, &worst);
    }
    if (body_.arms.size() != 2 && body_.legs.size() != 2) return;
    const bool good = most <= kMostAsymmetry;
    Add("symmetry", good,
        absl::StrFormat("left and right limbs differ by at most %s%s", Percent(most - 1),
                        good ? "" : absl::StrCat(" (", worst, ")")),
        {{"most_difference", most - 1}});
  }

  double MedianLength(const motion::Bone& bone) const {
    std::vector<float> lengths;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      lengths.push_back(Distance(clip_.at(frame, bone.parent), clip_.at(frame, bone.child)));
    }
    return static_cast<double>(base::Median(std::move(lengths)));
  }

  void Compare(const motion::Bone& a, const motion::Bone& b, double* most,
               std::string* worst) const {
    const double first = MedianLength(a), second = MedianLength(b);
    if (!(std::min(first, second) > 0)) return;
    const double ratio = std::max(first, second) / std::min(first, second);
    if (ratio <= *most) return;
    *most = ratio;
    *worst = absl::StrCat(skeleton_.joint_names[Index(a.parent)], " to ",
                          skeleton_.joint_names[Index(a.child)], " and its counterpart");
  }

  void CheckFloor() {
    if (!skeleton_.feet) return;
    const float floor = motion::FloorHeight(*skeleton_.feet, clip_.poses);
    const std::vector<float> feet = LowerFoot(*skeleton_.feet, clip_.poses);
    const double below = static_cast<double>(floor - *std::min_element(feet.begin(), feet.end()));
    const auto is_high = [floor](float foot) {
      return static_cast<double>(foot - floor) > kHighAboveFloor;
    };
    const double high = static_cast<double>(std::count_if(feet.begin(), feet.end(), is_high)) /
                        static_cast<double>(feet.size());
    std::string text = absl::StrFormat("at y = %.2f m", static_cast<double>(floor));
    if (below > kMostBelowFloor) absl::StrAppendFormat(&text, ", a foot gets %.2f m below", below);
    if (high > 0) {
      absl::StrAppendFormat(&text, ", both feet more than %.2f m above for %s of the time",
                            kHighAboveFloor, Percent(high));
    }
    Add("floor", below <= kMostBelowFloor && high <= kMostTimeInTheAir, text,
        {{"height_metres", static_cast<double>(floor)},
         {"below_metres", std::max(0.0, below)},
         {"share_in_the_air", high}});
  }

  void CheckJumps() {
    if (!(clip_.frame_rate_hz > 0) || clip_.frame_count() < 2) return;
    int jumps = 0, first = 0;
    double fastest = 0;
    int fastest_joint = 0;
    for (int frame = clip_.frame_count() - 1; frame > 0; --frame) {
      bool jumped = false;
      for (int joint = 0; joint < clip_.joint_count(); ++joint) {
        const double speed =
            static_cast<double>(Distance(clip_.at(frame, joint), clip_.at(frame - 1, joint))) *
            clip_.frame_rate_hz;
        jumped |= speed > (joint == skeleton_.root ? kFastestRoot : kFastestJoint);
        if (speed <= fastest) continue;
        fastest = speed;
        fastest_joint = joint;
      }
      if (!jumped) continue;
      ++jumps;
      first = frame;
    }
    std::string text = absl::StrFormat("fastest %s, %.1f m/s",
                                       skeleton_.joint_names[Index(fastest_joint)], fastest);
    if (jumps > 0)
      absl::StrAppend(&text, "; faster than people in ", jumps, " frames, first ", first);
    Add("jumps", jumps == 0, text, {{"jumps", jumps}, {"fastest_metres_per_second", fastest}});
  }

  // Whether a joint and its counterpart swap places in a frame.
  bool SwapsAt(int frame, int left, int right) const {
    const Vec3 l = clip_.at(frame, left), r = clip_.at(frame, right);
    const Vec3 l0 = clip_.at(frame - 1, left), r0 = clip_.at(frame - 1, right);
    return Distance(l0, r0) > kLeastSwap &&
           Distance(l, r0) + Distance(r, l0) < (Distance(l, l0) + Distance(r, r0)) / 2;
  }

  int CountSwaps() const {
    int swaps = 0;
    for (int frame = 1; frame < clip_.frame_count(); ++frame) {
      bool swapped =
          SwapsAt(frame, skeleton_.hips->left, skeleton_.hips->right) ||
          (skeleton_.feet && SwapsAt(frame, skeleton_.feet->left, skeleton_.feet->right));
      if (body_.arms.size() == 2) {
        swapped |= SwapsAt(frame, body_.arms[0].upper, body_.arms[1].upper) ||
                   SwapsAt(frame, body_.arms[0].end, body_.arms[1].end);
      }
      swaps += swapped ? 1 : 0;
    }
    return swaps;
  }

  // Distance of the middle of a limb from the line between its ends, in the direction that the hips
  // face. 0 if it is small.
  static double BendForwards(const body::Limb& limb, Vec3 facing, absl::Span<const Vec3> pose) {
    const Vec3 upper = pose[Index(limb.upper)], along = pose[Index(limb.end)] - upper;
    const float length = Dot(along, along);
    if (!(length > 0)) return 0;
    const Vec3 middle = pose[Index(limb.middle)] - upper;
    const float bend = Dot(middle - along * (Dot(middle, along) / length), facing);
    return std::abs(bend) < kLeastBend ? 0 : static_cast<double>(bend);
  }

  // The share of all bending of knees and elbows in the wrong direction relative to the hips: knees
  // bend forwards and elbows backwards; swapped sides reverse this. Absent if nothing bends.
  std::optional<double> ShareBentWrongly() const {
    double all = 0, wrong = 0;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      const absl::Span<const Vec3> pose = clip_.poses[frame];
      const Vec3 facing = body::Facing(*skeleton_.hips, pose);
      const auto add = [&](double right_way) {
        all += std::abs(right_way);
        wrong += std::max(0.0, -right_way);
      };
      for (const body::Limb& leg : body_.legs) add(BendForwards(leg, facing, pose));
      for (const body::Limb& arm : body_.arms) add(-BendForwards(arm, facing, pose));
    }
    if (all == 0) return std::nullopt;
    return wrong / all;
  }

  // Whether the shoulders face away from the direction of the hips, on average.
  bool ShouldersOppose() const {
    const std::optional<motion::JointPair> pair = Shoulders();
    if (!pair) return false;
    double sum = 0;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      const Vec3 hips =
          clip_.at(frame, skeleton_.hips->right) - clip_.at(frame, skeleton_.hips->left);
      const Vec3 shoulders = clip_.at(frame, pair->right) - clip_.at(frame, pair->left);
      sum += static_cast<double>(Dot(hips, shoulders));
    }
    return sum < 0;
  }

  void CheckSides() {
    if (!skeleton_.hips) return;
    const int swaps = CountSwaps();
    const std::optional<double> bent_wrongly = ShareBentWrongly();
    const bool oppose = ShouldersOppose();
    std::vector<std::string> wrong;
    if (oppose)
      wrong.push_back("left and right of the shoulders are opposite to those of the hips");
    if (bent_wrongly.value_or(0) > kMostBentWrongly) {
      wrong.push_back(
          absl::StrFormat("knees and elbows bend the wrong way (%.0f %% of their "
                          "bending): left and right may be swapped",
                          100 * *bent_wrongly));
    }
    if (swaps > 0)
      wrong.push_back(absl::StrCat("left and right change places in ", swaps, " frames"));
    std::string text = wrong.empty() ? "left and right are where they belong" : "";
    for (const std::string& what : wrong) absl::StrAppend(&text, text.empty() ? "" : "; ", what);
    std::map<std::string, double> figures = {{"swaps", swaps}, {"shoulders_oppose_hips", oppose}};
    if (bent_wrongly.has_value()) figures["bent_wrongly"] = *bent_wrongly;
    Add("sides", wrong.empty(), text, std::move(figures));
  }

  // Mean lean of the person in the direction of the hips, and to the left of it, in degrees.
  // `directions`: the standing direction of every frame.
  std::pair<double, double> LeanFromOwnView(const std::vector<Vec3>& directions) const {
    double forwards = 0, sideways = 0;
    const auto angle = [](Vec3 up, Vec3 way) {
      return base::kDegreesPerRadian *
             std::asin(std::clamp(static_cast<double>(Dot(up, way)), -1.0, 1.0));
    };
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      const Vec3 facing = body::Facing(*skeleton_.hips, clip_.poses[frame]);
      forwards += angle(directions[Index(frame)], facing);
      sideways += angle(directions[Index(frame)], Cross(Vec3{0, 1, 0}, facing));
    }
    return {forwards / clip_.frame_count(), sideways / clip_.frame_count()};
  }

  void CheckUpright() {
    if (!skeleton_.feet || !skeleton_.hips) return;
    const std::vector<Vec3> directions = motion::StandingDirections(skeleton_, clip_.poses);
    // Frames without a direction are left out there.
    if (directions.size() != Index(clip_.frame_count())) return;
    const Vec3 up = motion::RobustMean(directions);
    const double across = std::hypot(up.x, up.z);
    const double all = std::atan2(across, up.y) * base::kDegreesPerRadian;
    // Of a person who lies, the angles of motion::LeanOf are meaningless.
    const motion::Lean lean = {across > 0 ? all * up.x / across : 0,
                               across > 0 ? all * up.z / across : 0};
    const auto [forwards, sideways] = LeanFromOwnView(directions);
    const bool good =
        all <= kMostForwardLean && std::hypot(std::min(forwards, 0.0), sideways) <= kMostOtherLean;
    std::string text = absl::StrFormat(
        "leans %.1f degrees on average (%.1f towards x, %.1f towards z)", all, lean.x, lean.z);
    if (!good) text += ": a tilted camera or rotated axes, unless the person leans all the time";
    Add("upright", good, text,
        {{"lean_degrees", all},
         {"lean_x_degrees", lean.x},
         {"lean_z_degrees", lean.z},
         {"lean_forwards_degrees", forwards},
         {"lean_sideways_degrees", sideways}});
  }

  // The left and the right shoulder.
  std::optional<motion::JointPair> Shoulders() const {
    if (body_.arms.size() != 2) return std::nullopt;
    const bool first_is_left =
        skeleton_.joint_names[Index(body_.arms[0].upper)].find("left") != std::string::npos;
    return motion::JointPair{body_.arms[first_is_left ? 0 : 1].upper,
                             body_.arms[first_is_left ? 1 : 0].upper};
  }

  // Rotation from the hips to the shoulders about the trunk, 0 to 180 degrees. 0 if one of them has
  // no length.
  double Twist(const motion::JointPair& shoulders, int frame) const {
    const auto at = [this, frame](int joint) { return clip_.at(frame, joint); };
    const Vec3 trunk = at(shoulders.left) + at(shoulders.right) - at(skeleton_.hips->left) -
                       at(skeleton_.hips->right);
    const float length = Dot(trunk, trunk);
    if (!(length > 0)) return 0;
    const auto across = [&](const motion::JointPair& pair) {
      const Vec3 way = at(pair.right) - at(pair.left);
      return way - trunk * (Dot(way, trunk) / length);
    };
    const Vec3 hips = across(*skeleton_.hips), upper = across(shoulders);
    const double norms = static_cast<double>(Norm(hips)) * static_cast<double>(Norm(upper));
    if (!(norms > 0)) return 0;
    return std::acos(std::clamp(static_cast<double>(Dot(hips, upper)) / norms, -1.0, 1.0)) *
           base::kDegreesPerRadian;
  }

  void CheckWaist() {
    const std::optional<motion::JointPair> shoulders = Shoulders();
    if (!skeleton_.hips || !shoulders) return;
    double most = 0;
    int twisted = 0, worst = 0;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      const double twist = Twist(*shoulders, frame);
      twisted += twist > kMostTwist ? 1 : 0;
      if (twist > most) worst = frame;
      most = std::max(most, twist);
    }
    const double share = static_cast<double>(twisted) / clip_.frame_count();
    std::string text = absl::StrFormat(
        "shoulders turn at most %.0f degrees against the hips (frame %d)", most, worst);
    if (twisted > 0) {
      absl::StrAppendFormat(&text, ", more than %.0f for %s of the time", kMostTwist,
                            Percent(share));
    }
    Add("waist", share <= kMostTimeTwisted, text,
        {{"most_twist_degrees", most}, {"share_twisted", share}});
  }

  const motion::Clip& clip_;
  const motion::Skeleton& skeleton_;
  body::Body body_;
  std::vector<SkeletonCheck> checks_;
};

}  // namespace

std::vector<SkeletonCheck> CheckSkeleton(const motion::Clip& clip,
                                         const motion::Skeleton& skeleton) {
  return Checker(clip, skeleton).Run();
}

}  // namespace duet::client::cli
