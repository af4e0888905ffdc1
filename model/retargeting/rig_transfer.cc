#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/index.h"
#include "model/base/median.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/character.h"
#include "model/retargeting/foot_pose.h"

namespace duet::retargeting {
namespace {

using base::Index;

constexpr Vec3d kUp = {0, 1, 0};
// Metres. Shorter limbs, feet and hands have no direction; a root this near to the pelvis rotates
// with it.
constexpr double kNoLength = 0.01, kAtThePelvis = 0.3;
// Fraction of a limb's length that keeps it from being straight or folded, which has no plane.
constexpr double kSlack = 1e-4;
// Distance of the middle joint from the line between the ends, as a fraction of the limb. Below the
// first, the limb defines no direction; above the second, it defines it completely.
constexpr double kStraight = 0.02, kBent = 0.12;
// Radians. The slopes of feet that stand at rest, and how far outwards they point.
constexpr double kLeastSlope = -0.2, kMostSlope = 0.9, kMostToeOut = 0.8;
// Sine of the bend at rest above which the rest pose determines the hinge of elbow or knee.
constexpr double kBentAtRest = 0.15;
// Cosine of the maximum lean of the shin at rest at which the foot counts as flat.
constexpr double kShinHangs = 0.8;
// Weight of the previous rotation, for directions that a fit does not determine.
constexpr double kPreviousPrior = 1e-3;

double SmoothStep(double from, double to, double at) {
  const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vec3d Across(Vec3d a, Vec3d along) { return a - along * Dot(a, along); }

// Any perpendicular direction.
Vec3d SomeAcross(Vec3d along) {
  const Vec3d axis = std::abs(along.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
  return Unit(Across(axis, along), axis);
}

// The pose of a limb of two bones whose end is at a target.
struct LimbPose {
  Vec3d upper, lower;  // the directions of the bones, of length 1
  // The axis of the joint between them, of length 1 and perpendicular to both bones: a rotation
  // about it takes the upper bone's direction to the lower one's.
  Vec3d hinge;
};

// Reaches from `start` to `target`, or as near as the bones allow. `pole`, of length 1, is the
// direction in which the elbow or knee points.
LimbPose ReachFor(Vec3d start, Vec3d target, double upper_length, double lower_length, Vec3d pole) {
  const Vec3d along = Unit(target - start, {0, -1, 0});
  const Vec3d out = Unit(Across(pole, along), SomeAcross(along));
  const double slack = kSlack * (upper_length + lower_length);
  const double distance =
      std::clamp(Norm(target - start), std::abs(upper_length - lower_length) + slack,
                 upper_length + lower_length - slack);
  const double cosine =
      std::clamp((upper_length * upper_length + distance * distance - lower_length * lower_length) /
                     (2 * upper_length * distance),
                 -1.0, 1.0);
  LimbPose pose;
  pose.upper = along * cosine + out * std::sqrt(1 - cosine * cosine);
  pose.lower = Unit(along * distance - pose.upper * upper_length, along);
  pose.hinge = Cross(out, along);
  return pose;
}

// Tracks the direction in which the elbow or knee of a captured limb points. A nearly straight limb
// does not define it: the direction then stays fixed relative to the limb.
class PoleTracker {
 public:
  // `otherwise`, of length 1, is the direction until a bent limb has defined one.
  Vec3d Follow(Vec3d start, Vec3d middle, Vec3d end, Vec3d otherwise) {
    const Vec3d along = Unit(end - start, first_ ? Vec3d{0, -1, 0} : along_);
    const double length = Norm(middle - start) + Norm(end - middle);
    const Vec3d out = Across(middle - start, along);
    Vec3d kept = otherwise;
    if (!first_) kept = Rotate(ShortestArc(along_, along, SomeAcross(along_)), pole_);
    kept = Unit(Across(kept, along), SomeAcross(along));
    const double share = length > 0 ? SmoothStep(kStraight, kBent, Norm(out) / length) : 0.0;
    // Along the shorter arc, so that opposite directions do not cancel.
    const Vec3d said = Unit(out, kept);
    const Quaternion whole = ShortestArc(kept, said, along);
    const double angle = Angle(whole, {}) * share;
    const Vec3d axis = Unit(Vec3d{whole.x, whole.y, whole.z} * (whole.w < 0 ? -1.0 : 1.0), along);
    pole_ = Rotate(AxisAngle(axis, angle), kept);
    along_ = along;
    first_ = false;
    return pole_;
  }

 private:
  bool first_ = true;
  Vec3d along_, pole_;
};

std::vector<motion::Vec3> ToFloats(const std::vector<Vec3d>& positions) {
  std::vector<motion::Vec3> floats;
  for (const Vec3d& position : positions) floats.push_back(ToFloat(position));
  return floats;
}

// The axes of the first direction and of the part of the second that is perpendicular to it.
Quaternion Frame(Vec3d along, Vec3d across) {
  const Vec3d y = Unit(across - along * Dot(across, along), kUp);
  return FromAxes(along, y, Cross(along, y));
}

// An arm or a leg: its joints and its rest pose.
struct Limb {
  int start = 0, middle = 0, end = 0;                 // of the rig
  int clip_start = 0, clip_middle = 0, clip_end = 0;  // of the body
  double upper_length = 0, lower_length = 0;          // metres
  Quaternion upper_rest, lower_rest;                  // Frame(bone, hinge)
  bool leg = false;
  PoleTracker pole;
  // The joint beyond the end, a toe or knuckles: of the follower, -1 if it has none, and its offset
  // from the end on the rig at rest.
  int tip = -1;
  Vec3d tip_rest;
  int rig_toe = -1;  // of a leg: the rig's joint at the tip, -1 if it is that of the foot
};

class Transfer {
 public:
  // `follower` must outlive the object.
  Transfer(const motion::Clip& follower, BodyRoles roles, const CharacterRig& rig,
           absl::string_view source)
      : follower_(follower),
        roles_(std::move(roles)),
        rig_(rig),
        joints_(Compose(rig.joints, roles_.body)),
        skeleton_(motion::SbuSkeleton()),
        source_(source),
        rig_rest_(ApplyJointMap(rig.joints, ToFloats(rig.positions))) {
    body_.joint_names = skeleton_.joint_names;
    body_.frame_rate_hz = follower.frame_rate_hz;
    for (int frame = 0; frame < follower.frame_count(); ++frame) {
      body_.Append(ApplyJointMap(roles_.body, follower.poses[frame]));
    }
  }

  absl::Status Prepare() {
    for (const motion::Vec3& landmark : ApplyJointMap(joints_, ToFloats(rig_.positions))) {
      landmarks_.push_back(ToDouble(landmark));
    }
    FindBody();
    absl::Status status = AddLimb("left_shoulder", "left_elbow", "left_hand", false);
    if (status.ok()) status = AddLimb("right_shoulder", "right_elbow", "right_hand", false);
    if (status.ok()) status = AddLimb("left_hip", "left_knee", "left_foot", true);
    if (status.ok()) status = AddLimb("right_hip", "right_knee", "right_foot", true);
    if (!status.ok()) return status;
    return FindTrunk();
  }

  std::vector<CharacterPose> Run() {
    ankle_height_ = AnkleHeightOnFloor(skeleton_, body_);
    leg_ratio_ = LegRatio();
    if (roles_.toes.has_value()) {
      const motion::JointPair ankles{FollowersJoint(limbs_[2].clip_end),
                                     FollowersJoint(limbs_[3].clip_end)};
      foot_slope_ = FootSlopeOnFloor(ankles, *roles_.toes, follower_);
      toe_height_ = HeightOnFloor(*roles_.toes, follower_);
    }
    std::vector<CharacterPose> poses;
    for (int frame = 0; frame < body_.frame_count(); ++frame) poses.push_back(Pose(frame));
    return poses;
  }

 private:
  absl::Status Error(absl::string_view what) const {
    return absl::InvalidArgumentError(absl::StrCat(source_, ": rig: ", what));
  }

  Vec3d Rest(absl::string_view joint) const {
    return landmarks_[Index(skeleton_.Find(std::string(joint)))];
  }
  Vec3d RestAt(int joint) const { return rig_.positions[Index(joint)]; }

  // The follower's joint at a joint of the body's limbs, each of which is one joint.
  int FollowersJoint(int joint) const { return roles_.body.sources[Index(joint)].terms[0].joint; }

  // The direction that the rest pose faces.
  void FindBody() {
    const Vec3d hips = (Rest("left_hip") + Rest("right_hip")) * 0.5;
    const Vec3d left = Unit(Rest("left_hip") - Rest("right_hip"),
                            Unit(Rest("left_shoulder") - Rest("right_shoulder"), {1, 0, 0}));
    const Vec3d trunk = Unit(Rest("neck") - hips, kUp);
    const Vec3d up = Unit(trunk - left * Dot(trunk, left), kUp);
    facing_ = FromAxes(left, up, Cross(left, up));
  }

  absl::StatusOr<int> JointFor(const std::string& name) const {
    const JointSource& found = joints_.sources[Index(skeleton_.Find(name))];
    if (found.terms.size() == 1) return found.terms[0].joint;
    return Error(absl::StrCat(name, ": expected one joint of the rig, got a place between joints"));
  }

  bool IsBelow(int joint, int ancestor) const { return IsAtOrBelow(rig_.parents, joint, ancestor); }

  absl::Status AddLimb(const std::string& start, const std::string& middle, const std::string& end,
                       bool leg) {
    const absl::StatusOr<int> first = JointFor(start), second = JointFor(middle),
                              third = JointFor(end);
    for (const auto* joint : {&first, &second, &third}) {
      if (!joint->ok()) return joint->status();
    }
    if (!IsBelow(*third, *second) || !IsBelow(*second, *first)) {
      return Error(absl::StrCat("expected a chain, got ", start, ", ", middle, " and ", end));
    }
    Limb limb;
    limb.start = *first, limb.middle = *second, limb.end = *third;
    limb.clip_start = skeleton_.Find(start);
    limb.clip_middle = skeleton_.Find(middle);
    limb.clip_end = skeleton_.Find(end);
    const bool left = absl::string_view(start).substr(0, 4) == "left";
    limb.leg = leg;
    const Vec3d upper = RestAt(limb.middle) - RestAt(limb.start);
    const Vec3d lower = RestAt(limb.end) - RestAt(limb.middle);
    limb.upper_length = Norm(upper), limb.lower_length = Norm(lower);
    if (limb.upper_length < kNoLength || limb.lower_length < kNoLength) {
      return Error(absl::StrCat(middle, ": expected the bones of a limb, got ", limb.upper_length,
                                " and ", limb.lower_length, " m"));
    }
    const Vec3d u = Unit(upper, kUp), l = Unit(lower, kUp);
    const Vec3d hinge = RestHinge(u, l, leg, left);
    limb.upper_rest = Frame(u, hinge);
    limb.lower_rest = Frame(l, hinge);
    if (const auto& tips = leg ? roles_.toes : roles_.hands; tips.has_value()) {
      const int end_joint = FollowersJoint(limb.clip_end);
      limb.tip = left ? tips->left : tips->right;
      limb.tip_rest = ToDouble(rig_rest_[Index(limb.tip)]) - ToDouble(rig_rest_[Index(end_joint)]);
      if (leg) limb.rig_toe = RigJointBelow(end_joint, limb.tip);
    }
    limbs_.push_back(limb);
    return absl::OkStatus();
  }

  // The axis about which a limb bends: knees about the axis to the left; elbows of a T pose about
  // the vertical, so that forearms move forwards.
  Vec3d RestHinge(Vec3d upper, Vec3d lower, bool leg, bool left) const {
    const Vec3d side = Rotate(facing_, {left ? 1.0 : -1.0, 0, 0});
    const Vec3d vertical = Rotate(facing_, {0, left ? -1.0 : 1.0, 0});
    const Vec3d expected =
        leg ? Rotate(facing_, {1, 0, 0})
            : Rotate(ShortestArc(side, upper, Rotate(facing_, {0, 0, 1})), vertical);
    const Vec3d bend = Cross(upper, lower);
    // A bend in the wrong direction is slack of the rest pose and determines no plane.
    return Norm(bend) > kBentAtRest && Dot(bend, expected) > 0 ? Unit(bend, expected) : expected;
  }

  // The rig's joint at the follower's joint `tip`, if it is below the one at `end`; or -1.
  int RigJointBelow(int end, int tip) const {
    const auto& at_end = rig_.joints.sources[Index(end)].terms;
    const auto& at_tip = rig_.joints.sources[Index(tip)].terms;
    if (at_tip.size() != 1 || at_end.size() != 1) return -1;
    const int joint = at_tip[0].joint, above = at_end[0].joint;
    return joint != above && IsBelow(joint, above) ? joint : -1;
  }

  // The joints from below `top` to `joint`.
  std::vector<int> Chain(int top, int joint) const {
    std::vector<int> chain;
    for (; joint >= 0 && joint != top; joint = rig_.parents[Index(joint)]) chain.push_back(joint);
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  absl::Status FindTrunk() {
    for (const Limb& limb : limbs_) {
      if (IsBelow(limb.start, 0)) continue;
      return Error("expected limbs below one root, got several");
    }
    pelvis_ = CommonAncestor(rig_.parents, limbs_[2].start, limbs_[3].start);
    chest_ = CommonAncestor(rig_.parents, limbs_[0].start, limbs_[1].start);
    pelvis_ = CommonAncestor(rig_.parents, pelvis_, chest_);
    spine_ = Chain(pelvis_, chest_);
    const JointSource& head = joints_.sources[Index(skeleton_.Find("head"))];
    // The middle of the head is between its joint and its end.
    int joint = head.terms[0].joint;
    for (const JointSource::Term& term : head.terms) {
      if (IsBelow(joint, term.joint)) joint = term.joint;
    }
    if (IsBelow(joint, chest_)) neck_ = Chain(chest_, joint);
    driven_.assign(rig_.names.size(), false);
    return absl::OkStatus();
  }

  double LegRatio() const {
    std::vector<double> lengths;
    const Limb& leg = limbs_[2];
    for (int frame = 0; frame < body_.frame_count(); ++frame) {
      const Vec3d knee = ToDouble(body_.at(frame, leg.clip_middle));
      lengths.push_back(Norm(ToDouble(body_.at(frame, leg.clip_start)) - knee) +
                        Norm(ToDouble(body_.at(frame, leg.clip_end)) - knee));
    }
    const double length = base::Median(std::move(lengths));
    return length > kNoLength ? (leg.upper_length + leg.lower_length) / length : 1;
  }

  Vec3d At(int frame, const std::string& joint) const {
    return ToDouble(body_.at(frame, skeleton_.Find(joint)));
  }
  // Half way between the joints of both sides.
  Vec3d Middle(int frame, const std::string& joint) const {
    return (At(frame, "left_" + joint) + At(frame, "right_" + joint)) * 0.5;
  }
  Vec3d TipAt(int frame, const Limb& limb) const { return ToDouble(follower_.at(frame, limb.tip)); }

  // The rotation that takes a lateral direction and one up the trunk from rest to the clip.
  static Quaternion FitTurn(Vec3d rest_side, Vec3d rest_up, Vec3d side, Vec3d up,
                            Quaternion previous) {
    return FitRotation({{Unit(rest_side, {1, 0, 0}), Unit(side, {1, 0, 0}), 1},
                        {Unit(rest_up, kUp), Unit(up, kUp), 1}},
                       {{previous, kPreviousPrior}});
  }

  CharacterPose Pose(int frame) {
    CharacterPose pose;
    pose.turns.resize(rig_.names.size());
    pose.positions.resize(rig_.names.size());
    std::fill(driven_.begin(), driven_.end(), false);
    TurnTrunk(frame, &pose);
    PlacePelvis(frame, &pose);
    LeanSpine(frame, &pose);
    TurnHead(frame, &pose);
    Stand(&pose);
    for (Limb& limb : limbs_) TurnLimb(frame, &limb, &pose);
    Stand(&pose);
    return pose;
  }

  void Turn(int joint, Quaternion turn, CharacterPose* pose) {
    pose->turns[Index(joint)] = turn;
    driven_[Index(joint)] = true;
  }

  void TurnTrunk(int frame, CharacterPose* pose) {
    const Vec3d hips = Middle(frame, "hip");
    const Vec3d rest_hips = (Rest("left_hip") + Rest("right_hip")) * 0.5;
    // The rig's torso joint may coincide with the hips; the shoulders never do.
    const Vec3d rest_torso = Rest("torso") - rest_hips;
    const bool low = Norm(rest_torso) < kNoLength * 5;
    const char* upper = low ? "neck" : "torso";
    pelvis_turn_ = FitTurn(Rest("left_hip") - Rest("right_hip"), Rest(upper) - rest_hips,
                           At(frame, "left_hip") - At(frame, "right_hip"), At(frame, upper) - hips,
                           pelvis_turn_);
    const char* below = low ? "left_hip" : "torso";
    const Vec3d rest_from = low ? rest_hips : Rest(below);
    const Vec3d from = low ? hips : At(frame, below);
    chest_turn_ = FitTurn(Rest("left_shoulder") - Rest("right_shoulder"), Rest("neck") - rest_from,
                          At(frame, "left_shoulder") - At(frame, "right_shoulder"),
                          At(frame, "neck") - from, chest_turn_);
    // A root at the pelvis rotates with it; a root on the floor does not.
    for (int joint = rig_.parents[Index(pelvis_)]; joint >= 0; joint = rig_.parents[Index(joint)]) {
      const bool near = Norm(RestAt(joint) - RestAt(pelvis_)) < kAtThePelvis;
      Turn(joint, near ? pelvis_turn_ : Quaternion{}, pose);
    }
    Turn(pelvis_, pelvis_turn_, pose);
    for (std::size_t i = 0; i < spine_.size(); ++i) {
      const double share = static_cast<double>(i + 1) / static_cast<double>(spine_.size());
      Turn(spine_[i], Slerp(pelvis_turn_, chest_turn_, share), pose);
    }
  }

  // Scales the height of the hips to the rig's legs, at most as high as both legs reach.
  void PlacePelvis(int frame, CharacterPose* pose) {
    const Vec3d hips = Middle(frame, "hip");
    Vec3d target = hips;
    target.y = ankle_height_ + (hips.y - ankle_height_) * leg_ratio_;
    const Vec3d rest_hips = (RestAt(limbs_[2].start) + RestAt(limbs_[3].start)) * 0.5;
    for (const Limb& limb : limbs_) {
      if (!limb.leg) continue;
      const Vec3d ankle = ToDouble(body_.at(frame, limb.clip_end));
      const Vec3d hip = target + Rotate(pelvis_turn_, RestAt(limb.start) - rest_hips);
      const double reach = 0.9999 * (limb.upper_length + limb.lower_length);
      const double across = std::hypot(ankle.x - hip.x, ankle.z - hip.z);
      if (across >= reach) continue;
      target.y -= std::max(0.0, hip.y - ankle.y - std::sqrt(reach * reach - across * across));
    }
    pelvis_at_ = target + Rotate(pelvis_turn_, RestAt(pelvis_) - rest_hips);
    Stand(pose);
  }

  // Leans the trunk so that the shoulders are in the clip's direction from the hips.
  void LeanSpine(int frame, CharacterPose* pose) {
    if (spine_.empty()) return;
    const Vec3d target = Unit(Middle(frame, "shoulder") - Middle(frame, "hip"), kUp);
    const auto stands = [&](int joint) { return pose->positions[Index(joint)]; };
    const Vec3d from = (stands(limbs_[2].start) + stands(limbs_[3].start)) * 0.5;
    const Vec3d to = (stands(limbs_[0].start) + stands(limbs_[1].start)) * 0.5;
    const Quaternion lean = ShortestArc(Unit(to - from, target), target, {1, 0, 0});
    for (int joint : spine_) Turn(joint, lean * pose->turns[Index(joint)], pose);
    Stand(pose);
  }

  void TurnHead(int frame, CharacterPose* pose) {
    if (neck_.empty()) return;
    const Quaternion chest = pose->turns[Index(chest_)];
    const Vec3d at_rest = Unit(Rotate(chest, Rest("head") - Rest("neck")), kUp);
    const Vec3d target = Unit(At(frame, "head") - At(frame, "neck"), at_rest);
    const Quaternion whole = ShortestArc(at_rest, target, {1, 0, 0}) * chest;
    for (std::size_t i = 0; i < neck_.size(); ++i) {
      const double share = static_cast<double>(i + 1) / static_cast<double>(neck_.size());
      Turn(neck_[i], Slerp(chest, whole, share), pose);
    }
  }

  void TurnLimb(int frame, Limb* limb, CharacterPose* pose) {
    const Vec3d start = pose->positions[Index(limb->start)];
    const Vec3d target = ToDouble(body_.at(frame, limb->clip_end));
    // Knees point forwards, elbows backwards.
    const Quaternion trunk = pose->turns[Index(limb->leg ? pelvis_ : chest_)];
    const Vec3d otherwise = Rotate(trunk * facing_, {0, 0, limb->leg ? 1.0 : -1.0});
    const Vec3d pole =
        limb->pole.Follow(ToDouble(body_.at(frame, limb->clip_start)),
                          ToDouble(body_.at(frame, limb->clip_middle)), target, otherwise);
    const LimbPose reach = ReachFor(start, target, limb->upper_length, limb->lower_length, pole);
    const Quaternion lower = Frame(reach.lower, reach.hinge);
    Turn(limb->start, Frame(reach.upper, reach.hinge) * Inverse(limb->upper_rest), pose);
    Turn(limb->middle, lower * Inverse(limb->lower_rest), pose);
    if (!limb->leg) {
      return Turn(limb->end, HandTurn(frame, *limb, pose->turns[Index(limb->middle)]), pose);
    }
    const Vec3d ankle = start + reach.upper * limb->upper_length + reach.lower * limb->lower_length;
    TurnFoot(frame, *limb, lower, ankle, pose);
  }

  // The hand's rotation from its rest pose, on a forearm rotated by `forearm`, which it continues
  // without knuckles.
  Quaternion HandTurn(int frame, const Limb& arm, Quaternion forearm) const {
    if (arm.tip < 0 || Norm(arm.tip_rest) < kNoLength) return forearm;
    const Vec3d straight = Unit(Rotate(forearm, arm.tip_rest), {0, 1, 0});
    const Vec3d hand = TipAt(frame, arm) - ToDouble(body_.at(frame, arm.clip_end));
    if (Norm(hand) < kNoLength) return forearm;
    const Vec3d direction = Unit(hand, straight);
    const Vec3d axis =
        Unit(Cross(straight, Rotate(forearm, {0, 0, 1})), Rotate(forearm, {1, 0, 0}));
    return ShortestArc(straight, direction, axis) * forearm;
  }

  // The rotation of the rig's foot at rest. `expected` is that of a foot that points ahead; `flat`:
  // the leg stands at rest, so a foot of a usual slope is level on the floor.
  Quaternion FootAtRest(const Limb& leg, Quaternion expected, bool flat) const {
    if (leg.rig_toe < 0 || Norm(leg.tip_rest) < kNoLength) return expected;
    const Vec3d foot = Rotate(Inverse(expected), leg.tip_rest);
    const double slope = std::atan2(-foot.y, std::hypot(foot.x, foot.z));
    const double outwards = std::atan2(foot.x, foot.z);
    if (flat && slope > kLeastSlope && slope < kMostSlope && std::abs(outwards) < kMostToeOut) {
      return expected * AxisAngle({0, 1, 0}, outwards);
    }
    // A foot that hangs or points elsewhere takes its slope from the follower's.
    return FootRotationWithToe(expected, {}, leg.tip_rest, foot_slope_);
  }

  // Requires the leg's other turns. `lower`: Frame(shin, hinge).
  void TurnFoot(int frame, const Limb& leg, Quaternion lower, Vec3d ankle, CharacterPose* pose) {
    // In the canonical pose the shin hangs and bends about the axis to the left.
    const Quaternion hangs = Frame({0, -1, 0}, {1, 0, 0});
    const Vec3d rest_down = Rotate(leg.lower_rest, {1, 0, 0});
    const bool flat = Dot(rest_down, Rotate(facing_, {0, -1, 0})) > kShinHangs;
    const Quaternion rest = FootAtRest(leg, flat ? facing_ : leg.lower_rest * Inverse(hangs), flat);
    Quaternion foot = FootRotation(lower * Inverse(hangs), ankle, ankle_height_);
    if (leg.tip >= 0) {
      foot = FootRotationWithToe(foot, ToDouble(body_.at(frame, leg.clip_end)), TipAt(frame, leg),
                                 foot_slope_);
    }
    Turn(leg.end, foot * Inverse(rest), pose);
    if (leg.rig_toe < 0) return;
    // Toes are level on the floor while the heel is up.
    const Quaternion toes = FootRotation(foot, TipAt(frame, leg), toe_height_);
    Turn(leg.rig_toe, toes * Inverse(rest), pose);
  }

  // Joints without a target rotation follow their parents. Positions follow from the rotations.
  void Stand(CharacterPose* pose) const {
    for (std::size_t j = 0; j < rig_.names.size(); ++j) {
      const int parent = rig_.parents[j];
      if (parent < 0) {
        if (!driven_[j]) pose->turns[j] = {};
        pose->positions[j] = {};
        continue;
      }
      if (!driven_[j]) pose->turns[j] = pose->turns[Index(parent)];
      pose->positions[j] = pose->positions[Index(parent)] +
                           Rotate(pose->turns[Index(parent)], rig_.positions[j] - RestAt(parent));
    }
    Move(pose);
  }

  // Moves the pelvis to its position, or the whole rig if the pelvis cannot move.
  void Move(CharacterPose* pose) const {
    const bool alone = pelvis_ != 0 && rig_.moves[Index(pelvis_)];
    const Vec3d root = alone ? rig_.positions[0] : Vec3d{};
    const Vec3d by = pelvis_at_ - pose->positions[Index(pelvis_)];
    for (std::size_t j = 0; j < rig_.names.size(); ++j) {
      const bool with_pelvis = !alone || IsBelow(static_cast<int>(j), pelvis_);
      pose->positions[j] += with_pelvis ? by : root;
    }
  }

  const motion::Clip& follower_;
  const BodyRoles roles_;  // of the follower
  const CharacterRig& rig_;
  const JointMap joints_;            // the body's joints from the rig's
  const motion::Skeleton skeleton_;  // of the body
  const std::string source_;
  const std::vector<motion::Vec3> rig_rest_;  // the follower's joints on the rig at rest
  motion::Clip body_;                         // the follower's motion, of the body's joints
  std::vector<Vec3d> landmarks_;              // the body's joints on the rig at rest
  Quaternion facing_;                         // from x left, y up, z ahead to the rest pose
  std::vector<Limb> limbs_;                   // arms, then legs, the left one first
  int pelvis_ = 0, chest_ = 0;
  std::vector<int> spine_, neck_;  // below the pelvis to the chest; below the chest to the head
  std::vector<bool> driven_;
  double ankle_height_ = 0, leg_ratio_ = 1;
  double foot_slope_ = 0, toe_height_ = 0;  // of standing feet: radians, metres
  Quaternion pelvis_turn_, chest_turn_;
  Vec3d pelvis_at_;
};

}  // namespace

absl::StatusOr<std::vector<CharacterPose>> TransferToRig(const motion::Clip& clip,
                                                         const CharacterRig& rig,
                                                         absl::string_view source) {
  absl::Status status = CheckClip("follower", clip);
  if (!status.ok()) return status;
  const std::size_t joints = rig.joints.sources.size();
  if (clip.joint_names.size() != joints) {
    return absl::InvalidArgumentError(absl::StrCat("follower: joints: expected the ", joints,
                                                   " joints that the rig is read for, got ",
                                                   clip.joint_count()));
  }
  absl::StatusOr<BodyRoles> roles = FindBodyRoles("follower", clip);
  if (!roles.ok()) return roles.status();
  Transfer transfer(clip, *std::move(roles), rig, source);
  status = transfer.Prepare();
  if (!status.ok()) return status;
  return transfer.Run();
}

}  // namespace duet::retargeting
