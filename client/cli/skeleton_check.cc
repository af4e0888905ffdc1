#include "client/cli/skeleton_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/types/span.h"
#include "model/base/index.h"
#include "model/base/median.h"
#include "model/body/limbs.h"
#include "model/motion/feet.h"
#include "model/motion/inferred_coordinates.h"

namespace duet::client::cli {
namespace {

using motion::Vec3;

// Standard deviation of a bone's length divided by its mean; up to 0.1 for Kinect's bones.
constexpr double kMostDrift = 0.1;
// Rounding errors, in any unit.
constexpr double kLeastLength = 1e-6;
constexpr double kMostBelowFloor = 0.1, kHighAboveFloor = 0.15, kMostTimeInTheAir = 0.25;
// A fist in boxing reaches 11 m/s, a kicking foot 16.
constexpr double kFastestJoint = 20, kFastestRoot = 10;
// A knee or an elbow counts as bent if it is this far off the line between the limb's ends. If more
// than this share of the bending is in the wrong direction, it is not noise.
constexpr float kLeastBend = 0.04f;
constexpr double kMostBentWrongly = 0.8;

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
    CheckFloor();
    CheckJumps();
    CheckSides();
    return std::move(checks_);
  }

 private:
  void Add(std::string name, bool good, std::string text) {
    checks_.push_back({std::move(name), good, std::move(text)});
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
                 : absl::StrCat("a position is not finite in ", bad, " frames, first in ", first));
  }

  void CheckSize() {
    if (!skeleton_.feet) return;
    const double leg = motion::LegLength(skeleton_, clip_.poses);
    const bool good = motion::IsLegLength(leg);
    Add("size", good,
        absl::StrFormat("foot to %s %.2f m%s", skeleton_.joint_names[Index(skeleton_.root)], leg,
                        good ? ""
                             : absl::StrFormat(", expected %.1f to %.1f m. Check the unit",
                                               motion::kShortestLeg, motion::kLongestLeg)));
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
    Add("limb lengths", most <= kMostDrift && none.empty(), text);
  }

  double MedianLength(const motion::Bone& bone) const {
    std::vector<float> lengths;
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      lengths.push_back(Distance(clip_.at(frame, bone.parent), clip_.at(frame, bone.child)));
    }
    return static_cast<double>(base::Median(std::move(lengths)));
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
    Add("floor", below <= kMostBelowFloor && high <= kMostTimeInTheAir, text);
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
    Add("jumps", jumps == 0, text);
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
    std::string text = wrong.empty() ? "left and right are where they belong" : "";
    for (const std::string& what : wrong) absl::StrAppend(&text, text.empty() ? "" : "; ", what);
    Add("sides", wrong.empty(), text);
  }

  // The left and the right shoulder.
  std::optional<motion::JointPair> Shoulders() const {
    if (body_.arms.size() != 2) return std::nullopt;
    const bool first_is_left =
        skeleton_.joint_names[Index(body_.arms[0].upper)].find("left") != std::string::npos;
    return motion::JointPair{body_.arms[first_is_left ? 0 : 1].upper,
                             body_.arms[first_is_left ? 1 : 0].upper};
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
