#include <algorithm>
#include <array>
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

// The clip's joint in a role that is one joint, which wrists and ankles always are.
int JointOf(const BodyRoles& roles, const char* role) {
  return roles.body.sources[Index(motion::SbuSkeleton().Find(role))].terms[0].joint;
}

// The rig's joint at `tip`, if it is another one than at `end`.
int RigJoint(const CharacterRig& rig, int end, int tip) {
  const auto& at_end = rig.joints.sources[Index(end)].terms;
  const auto& at_tip = rig.joints.sources[Index(tip)].terms;
  if (at_tip.size() != 1 || at_end.size() != 1) return -1;
  for (int joint = rig.parents[Index(at_tip[0].joint)]; joint >= 0;
       joint = rig.parents[Index(joint)]) {
    if (joint == at_end[0].joint) return at_tip[0].joint;
  }
  return -1;
}

// Rotations of a rig's feet, toes and hands from a clip with joints beyond ankles and wrists.
// Without such joints, feet and hands keep the rotations that they are given.
class LimbEnds {
 public:
  enum class Side { kLeft, kRight };

  // `clip` must outlive the object. `landmarks` are the clip's joints on the rig at rest.
  // [clip joints], metres.
  LimbEnds(const motion::Clip& clip, const BodyRoles& roles, const CharacterRig& rig,
           absl::Span<const motion::Vec3> landmarks)
      : clip_(clip) {
    ends_[0].ankle = JointOf(roles, "left_foot");
    ends_[1].ankle = JointOf(roles, "right_foot");
    ends_[0].wrist = JointOf(roles, "left_hand");
    ends_[1].wrist = JointOf(roles, "right_hand");
    const auto between = [&landmarks](int from, int to) {
      return ToDouble(landmarks[Index(to)]) - ToDouble(landmarks[Index(from)]);
    };
    if (roles.toes.has_value()) {
      ends_[0].toe = roles.toes->left, ends_[1].toe = roles.toes->right;
      foot_slope_ = FootSlopeOnFloor({ends_[0].ankle, ends_[1].ankle}, *roles.toes, clip);
      toe_height_ = HeightOnFloor(*roles.toes, clip);
    }
    if (roles.hands.has_value())
      ends_[0].hand = roles.hands->left, ends_[1].hand = roles.hands->right;
    for (Ends& ends : ends_) {
      if (ends.toe >= 0) {
        ends.foot_rest = between(ends.ankle, ends.toe);
        ends.rig_toe = RigJoint(rig, ends.ankle, ends.toe);
      }
      if (ends.hand >= 0) ends.hand_rest = between(ends.wrist, ends.hand);
    }
  }

  // The rig's toe joint below `ankle`, or -1 if the rig or the clip has none.
  int ToeJoint(Side side) const { return At(side).rig_toe; }

  // The rotation of the rig's foot at rest. `expected` is that of a foot that points ahead; `flat`:
  // the leg stands at rest, so a foot of a usual slope is level on the floor.
  Quaternion FootAtRest(Side side, Quaternion expected, bool flat) const {
    const Ends& ends = At(side);
    if (ends.rig_toe < 0 || Norm(ends.foot_rest) < kNoLength) return expected;
    const Vec3d foot = Rotate(Inverse(expected), ends.foot_rest);
    const double slope = std::atan2(-foot.y, std::hypot(foot.x, foot.z));
    const double outwards = std::atan2(foot.x, foot.z);
    if (flat && slope > kLeastSlope && slope < kMostSlope && std::abs(outwards) < kMostToeOut) {
      return expected * AxisAngle({0, 1, 0}, outwards);
    }
    // A foot that hangs or points elsewhere takes its slope from the clip's.
    return FootRotationWithToe(expected, {}, ends.foot_rest, foot_slope_);
  }

  // The foot's rotation in the world; `without_toe` is that of FootRotation.
  Quaternion Foot(Side side, int frame, Quaternion without_toe) const {
    const Ends& ends = At(side);
    if (ends.toe < 0) return without_toe;
    return FootRotationWithToe(without_toe, Position(frame, ends.ankle), Position(frame, ends.toe),
                               foot_slope_);
  }

  // The rotation of the toes on `foot`: level on the floor while the heel is up.
  Quaternion Toes(Side side, int frame, Quaternion foot) const {
    return FootRotation(foot, Position(frame, At(side).toe), toe_height_);
  }

  // The hand's rotation from its rest pose, on a forearm rotated by `forearm`.
  Quaternion Hand(Side side, int frame, Quaternion forearm) const {
    const Ends& ends = At(side);
    if (ends.hand < 0 || Norm(ends.hand_rest) < kNoLength) return forearm;
    const Vec3d straight = Unit(Rotate(forearm, ends.hand_rest), {0, 1, 0});
    const Vec3d hand = Position(frame, ends.hand) - Position(frame, ends.wrist);
    if (Norm(hand) < kNoLength) return forearm;
    const Vec3d direction = Unit(hand, straight);
    const Vec3d axis =
        Unit(Cross(straight, Rotate(forearm, {0, 0, 1})), Rotate(forearm, {1, 0, 0}));
    return ShortestArc(straight, direction, axis) * forearm;
  }

 private:
  // The ends of one side. Indices are those of the clip's joints, -1 if it has none.
  struct Ends {
    int ankle = -1, toe = -1, wrist = -1, hand = -1;
    Vec3d foot_rest, hand_rest;  // from ankle to toe and from wrist to hand on the rig at rest
    int rig_toe = -1;            // of the rig
  };

  const Ends& At(Side side) const { return ends_[side == Side::kLeft ? 0 : 1]; }
  Vec3d Position(int frame, int joint) const { return ToDouble(clip_.at(frame, joint)); }

  const motion::Clip& clip_;
  std::array<Ends, 2> ends_;
  double foot_slope_ = 0, toe_height_ = 0;  // of standing feet: radians, metres
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
  LimbEnds::Side side = LimbEnds::Side::kLeft;
  PoleTracker pole;
};

// The body's joints of a clip.
motion::Clip BodyOf(const motion::Clip& clip, const JointMap& body) {
  motion::Clip mapped;
  mapped.joint_names = motion::SbuSkeleton().joint_names;
  mapped.frame_rate_hz = clip.frame_rate_hz;
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    mapped.Append(ApplyJointMap(body, clip.poses[frame]));
  }
  return mapped;
}

class Transfer {
 public:
  // `body` maps the body's joints to the rig's.
  Transfer(const CharacterRig& rig, JointMap body, const LimbEnds& ends, absl::string_view source)
      : rig_(rig),
        joints_(std::move(body)),
        ends_(ends),
        skeleton_(motion::SbuSkeleton()),
        source_(source) {}

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

  // `clip` has the body's joints.
  std::vector<CharacterPose> Run(const motion::Clip& clip) {
    ankle_height_ = AnkleHeightOnFloor(skeleton_, clip);
    leg_ratio_ = LegRatio(clip);
    std::vector<CharacterPose> poses;
    for (int frame = 0; frame < clip.frame_count(); ++frame) poses.push_back(Pose(clip, frame));
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

  // The direction that the rest pose faces.
  void FindBody() {
    const Vec3d hips = (Rest("left_hip") + Rest("right_hip")) * 0.5;
    const Vec3d left = Unit(Rest("left_hip") - Rest("right_hip"),
                            Unit(Rest("left_shoulder") - Rest("right_shoulder"), {1, 0, 0}));
    const Vec3d trunk = Unit(Rest("neck") - hips, kUp);
    const Vec3d up = Unit(trunk - left * Dot(trunk, left), kUp);
    body_ = FromAxes(left, up, Cross(left, up));
  }

  absl::StatusOr<int> JointFor(const std::string& name) const {
    const JointSource& found = joints_.sources[Index(skeleton_.Find(name))];
    if (found.terms.size() == 1) return found.terms[0].joint;
    return Error(absl::StrCat(name, ": expected one joint of the rig, got a place between joints"));
  }

  bool IsBelow(int joint, int ancestor) const {
    for (; joint >= 0; joint = rig_.parents[Index(joint)]) {
      if (joint == ancestor) return true;
    }
    return false;
  }

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
    limb.side = left ? LimbEnds::Side::kLeft : LimbEnds::Side::kRight;
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
    limbs_.push_back(limb);
    return absl::OkStatus();
  }

  // The axis about which a limb bends: knees about the axis to the left; elbows of a T pose about
  // the vertical, so that forearms move forwards.
  Vec3d RestHinge(Vec3d upper, Vec3d lower, bool leg, bool left) const {
    const Vec3d side = Rotate(body_, {left ? 1.0 : -1.0, 0, 0});
    const Vec3d vertical = Rotate(body_, {0, left ? -1.0 : 1.0, 0});
    const Vec3d expected =
        leg ? Rotate(body_, {1, 0, 0})
            : Rotate(ShortestArc(side, upper, Rotate(body_, {0, 0, 1})), vertical);
    const Vec3d bend = Cross(upper, lower);
    // A bend in the wrong direction is slack of the rest pose and determines no plane.
    return Norm(bend) > kBentAtRest && Dot(bend, expected) > 0 ? Unit(bend, expected) : expected;
  }

  int CommonAncestor(int a, int b) const {
    while (!IsBelow(b, a)) a = rig_.parents[Index(a)];
    return a;
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
    pelvis_ = CommonAncestor(limbs_[2].start, limbs_[3].start);
    chest_ = CommonAncestor(limbs_[0].start, limbs_[1].start);
    pelvis_ = CommonAncestor(pelvis_, chest_);
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

  double LegRatio(const motion::Clip& clip) const {
    std::vector<double> lengths;
    const Limb& leg = limbs_[2];
    for (int frame = 0; frame < clip.frame_count(); ++frame) {
      const Vec3d knee = ToDouble(clip.at(frame, leg.clip_middle));
      lengths.push_back(Norm(ToDouble(clip.at(frame, leg.clip_start)) - knee) +
                        Norm(ToDouble(clip.at(frame, leg.clip_end)) - knee));
    }
    const double length = base::Median(std::move(lengths));
    return length > kNoLength ? (leg.upper_length + leg.lower_length) / length : 1;
  }

  Vec3d At(const motion::Clip& clip, int frame, absl::string_view joint) const {
    return ToDouble(clip.at(frame, skeleton_.Find(std::string(joint))));
  }

  // The rotation that takes a lateral direction and one up the trunk from rest to the clip.
  static Quaternion FitTurn(Vec3d rest_side, Vec3d rest_up, Vec3d side, Vec3d up,
                            Quaternion previous) {
    return FitRotation({{Unit(rest_side, {1, 0, 0}), Unit(side, {1, 0, 0}), 1},
                        {Unit(rest_up, kUp), Unit(up, kUp), 1}},
                       {{previous, kPreviousPrior}});
  }

  CharacterPose Pose(const motion::Clip& clip, int frame) {
    CharacterPose pose;
    pose.turns.resize(rig_.names.size());
    pose.positions.resize(rig_.names.size());
    std::fill(driven_.begin(), driven_.end(), false);
    TurnTrunk(clip, frame, &pose);
    PlacePelvis(clip, frame, &pose);
    LeanSpine(clip, frame, &pose);
    TurnHead(clip, frame, &pose);
    Stand(&pose);
    for (Limb& limb : limbs_) TurnLimb(clip, frame, &limb, &pose);
    Stand(&pose);
    return pose;
  }

  void Turn(int joint, Quaternion turn, CharacterPose* pose) {
    pose->turns[Index(joint)] = turn;
    driven_[Index(joint)] = true;
  }

  void TurnTrunk(const motion::Clip& clip, int frame, CharacterPose* pose) {
    const Vec3d hips = (At(clip, frame, "left_hip") + At(clip, frame, "right_hip")) * 0.5;
    const Vec3d rest_hips = (Rest("left_hip") + Rest("right_hip")) * 0.5;
    // The rig's torso joint may coincide with the hips; the shoulders never do.
    const Vec3d rest_torso = Rest("torso") - rest_hips;
    const bool low = Norm(rest_torso) < kNoLength * 5;
    const char* upper = low ? "neck" : "torso";
    pelvis_turn_ = FitTurn(Rest("left_hip") - Rest("right_hip"), Rest(upper) - rest_hips,
                           At(clip, frame, "left_hip") - At(clip, frame, "right_hip"),
                           At(clip, frame, upper) - hips, pelvis_turn_);
    const char* below = low ? "left_hip" : "torso";
    const Vec3d rest_from = low ? rest_hips : Rest(below);
    const Vec3d from = low ? hips : At(clip, frame, below);
    chest_turn_ = FitTurn(Rest("left_shoulder") - Rest("right_shoulder"), Rest("neck") - rest_from,
                          At(clip, frame, "left_shoulder") - At(clip, frame, "right_shoulder"),
                          At(clip, frame, "neck") - from, chest_turn_);
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
  void PlacePelvis(const motion::Clip& clip, int frame, CharacterPose* pose) {
    const Vec3d hips = (At(clip, frame, "left_hip") + At(clip, frame, "right_hip")) * 0.5;
    Vec3d target = hips;
    target.y = ankle_height_ + (hips.y - ankle_height_) * leg_ratio_;
    const Vec3d rest_hips = (RestAt(limbs_[2].start) + RestAt(limbs_[3].start)) * 0.5;
    for (const Limb& limb : limbs_) {
      if (!limb.leg) continue;
      const Vec3d ankle = ToDouble(clip.at(frame, limb.clip_end));
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
  void LeanSpine(const motion::Clip& clip, int frame, CharacterPose* pose) {
    if (spine_.empty()) return;
    const Vec3d hips = (At(clip, frame, "left_hip") + At(clip, frame, "right_hip")) * 0.5;
    const Vec3d shoulders =
        (At(clip, frame, "left_shoulder") + At(clip, frame, "right_shoulder")) * 0.5;
    const Vec3d target = Unit(shoulders - hips, kUp);
    const auto stands = [&](int joint) { return pose->positions[Index(joint)]; };
    const Vec3d from = (stands(limbs_[2].start) + stands(limbs_[3].start)) * 0.5;
    const Vec3d to = (stands(limbs_[0].start) + stands(limbs_[1].start)) * 0.5;
    const Quaternion lean = ShortestArc(Unit(to - from, target), target, {1, 0, 0});
    for (int joint : spine_) Turn(joint, lean * pose->turns[Index(joint)], pose);
    Stand(pose);
  }

  void TurnHead(const motion::Clip& clip, int frame, CharacterPose* pose) {
    if (neck_.empty()) return;
    const Quaternion chest = pose->turns[Index(chest_)];
    const Vec3d at_rest = Unit(Rotate(chest, Rest("head") - Rest("neck")), kUp);
    const Vec3d target = Unit(At(clip, frame, "head") - At(clip, frame, "neck"), at_rest);
    const Quaternion whole = ShortestArc(at_rest, target, {1, 0, 0}) * chest;
    for (std::size_t i = 0; i < neck_.size(); ++i) {
      const double share = static_cast<double>(i + 1) / static_cast<double>(neck_.size());
      Turn(neck_[i], Slerp(chest, whole, share), pose);
    }
  }

  void TurnLimb(const motion::Clip& clip, int frame, Limb* limb, CharacterPose* pose) {
    const Vec3d start = pose->positions[Index(limb->start)];
    const Vec3d target = ToDouble(clip.at(frame, limb->clip_end));
    // Knees point forwards, elbows backwards.
    const Quaternion trunk = pose->turns[Index(limb->leg ? pelvis_ : chest_)];
    const Vec3d otherwise = Rotate(trunk * body_, {0, 0, limb->leg ? 1.0 : -1.0});
    const Vec3d pole =
        limb->pole.Follow(ToDouble(clip.at(frame, limb->clip_start)),
                          ToDouble(clip.at(frame, limb->clip_middle)), target, otherwise);
    const LimbPose reach = ReachFor(start, target, limb->upper_length, limb->lower_length, pole);
    const Quaternion lower = Frame(reach.lower, reach.hinge);
    Turn(limb->start, Frame(reach.upper, reach.hinge) * Inverse(limb->upper_rest), pose);
    Turn(limb->middle, lower * Inverse(limb->lower_rest), pose);
    if (!limb->leg) {
      const Quaternion forearm = pose->turns[Index(limb->middle)];
      return Turn(limb->end, ends_.Hand(limb->side, frame, forearm), pose);
    }
    const Vec3d ankle = start + reach.upper * limb->upper_length + reach.lower * limb->lower_length;
    TurnFoot(frame, *limb, lower, ankle, pose);
  }

  // Requires the leg's other turns. `lower`: Frame(shin, hinge).
  void TurnFoot(int frame, const Limb& leg, Quaternion lower, Vec3d ankle, CharacterPose* pose) {
    // In the canonical pose the shin hangs and bends about the axis to the left.
    const Quaternion hangs = Frame({0, -1, 0}, {1, 0, 0});
    const Vec3d rest_down = Rotate(leg.lower_rest, {1, 0, 0});
    const bool flat_at_rest = Dot(rest_down, Rotate(body_, {0, -1, 0})) > kShinHangs;
    const Quaternion rest = ends_.FootAtRest(
        leg.side, flat_at_rest ? body_ : leg.lower_rest * Inverse(hangs), flat_at_rest);
    const Quaternion foot =
        ends_.Foot(leg.side, frame, FootRotation(lower * Inverse(hangs), ankle, ankle_height_));
    Turn(leg.end, foot * Inverse(rest), pose);
    const int toe = ends_.ToeJoint(leg.side);
    if (toe >= 0) Turn(toe, ends_.Toes(leg.side, frame, foot) * Inverse(rest), pose);
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

  const CharacterRig& rig_;
  const JointMap joints_;  // the body's joints from the rig's
  const LimbEnds& ends_;
  const motion::Skeleton skeleton_;  // of the body
  const std::string source_;
  std::vector<Vec3d> landmarks_;  // the body's joints on the rig at rest
  Quaternion body_;               // from x left, y up, z ahead to the rest pose
  std::vector<Limb> limbs_;       // arms, then legs, the left one first
  int pelvis_ = 0, chest_ = 0;
  std::vector<int> spine_, neck_;  // below the pelvis to the chest; below the chest to the head
  std::vector<bool> driven_;
  double ankle_height_ = 0, leg_ratio_ = 1;
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
  const absl::StatusOr<BodyRoles> roles = FindBodyRoles("follower", clip);
  if (!roles.ok()) return roles.status();
  const LimbEnds ends(clip, *roles, rig, ApplyJointMap(rig.joints, ToFloats(rig.positions)));
  Transfer transfer(rig, Compose(rig.joints, roles->body), ends, source);
  status = transfer.Prepare();
  if (!status.ok()) return status;
  return transfer.Run(BodyOf(clip, roles->body));
}

}  // namespace duet::retargeting
