#ifndef DUET_MODEL_RETARGETING_LIMB_ENDS_H_
#define DUET_MODEL_RETARGETING_LIMB_ENDS_H_

#include <array>

#include "absl/types/span.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/character_rig.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The pose of a limb of two bones whose end is at a target.
struct LimbPose {
  Vec3d upper, lower;  // the directions of the bones, of length 1
  // The axis of the joint between them, of length 1 and perpendicular to both bones: a rotation
  // about it takes the upper bone's direction to the lower one's.
  Vec3d hinge;
};

// Reaches from `start` to `target`, or as near as the bones allow. `pole`, of length 1, is the
// direction in which the elbow or knee points.
LimbPose ReachFor(Vec3d start, Vec3d target, double upper_length, double lower_length, Vec3d pole);

// Tracks the direction in which the elbow or knee of a captured limb points. A nearly straight limb
// does not define it: the direction then stays fixed relative to the limb.
class PoleTracker {
 public:
  // `otherwise`, of length 1, is the direction until a bent limb has defined one.
  Vec3d Follow(Vec3d start, Vec3d middle, Vec3d end, Vec3d otherwise);

 private:
  bool first_ = true;
  Vec3d along_, pole_;
};

// Rotations of a rig's feet, toes and hands from a clip with joints beyond ankles and wrists.
// Without such joints, feet and hands keep the rotations that they are given.
class LimbEnds {
 public:
  enum class Side { kLeft, kRight };

  // `clip` must outlive the object. `landmarks` are the clip's joints on the rig at rest.
  // [clip joints], metres.
  LimbEnds(const motion::Clip& clip, const BodyRoles& roles, const CharacterRig& rig,
           absl::Span<const motion::Vec3> landmarks);

  // The rig's toe joint below `ankle`, or -1 if the rig or the clip has none.
  int ToeJoint(Side side) const { return At(side).rig_toe; }
  // The rotation of the rig's foot at rest. `expected` is that of a foot that points ahead; `flat`:
  // the leg stands at rest, so a foot of a usual slope is level on the floor.
  Quaternion FootAtRest(Side side, Quaternion expected, bool flat) const;

  // The foot's rotation in the world; `without_toe` is that of FootRotation.
  Quaternion Foot(Side side, int frame, Quaternion without_toe) const;
  // The rotation of the toes on `foot`: level on the floor while the heel is up.
  Quaternion Toes(Side side, int frame, Quaternion foot) const;
  // The hand's rotation from its rest pose, on a forearm rotated by `forearm`.
  Quaternion Hand(Side side, int frame, Quaternion forearm) const;

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

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_LIMB_ENDS_H_
