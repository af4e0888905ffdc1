#ifndef DUET_MODEL_RETARGETING_RIG_FITTING_H_
#define DUET_MODEL_RETARGETING_RIG_FITTING_H_

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/rotation.h"

// The rig of a skeleton, and its poses from joint positions: one frame (PoseFitter), a file or an
// answer (RigFitter), a session (EndlessRigFitter), a whole clip (AnimateRig).

namespace duet::retargeting {

// A joint of a rig: a skeleton's joint, or a helper at the position of a joint with several
// children. A helper points at one child, so that hips, shoulders and neck can move relative to
// each other.
struct RigJoint {
  enum class Kind {
    kBranch,  // several children: turns with all its neighbours
    kAim,     // a helper or a limb's joint: points at one child
    kLeaf
  };
  std::string name;  // the skeleton's, or "torso_to_neck" for a helper
  Kind kind = Kind::kLeaf;
  int parent = -1;  // an earlier rig joint
  int joint = 0;    // the skeleton's joint at this position
  Vec3d offset;     // from the parent in the rest pose, metres

  // kAim: the skeleton's joint that it points at, that joint's position in the rest pose, and the
  // next joint, whose plane defines the twist (-1 if there is none).
  int aim = -1;
  Vec3d rest_direction = {0, 1, 0};
  int bend = -1;

  // kBranch: neighbours on the skeleton, and their rest positions relative to this joint.
  std::vector<int> neighbours;
  std::vector<Vec3d> rest_shape;

  // kLeaf: the offset of the End Site.
  Vec3d end_offset;
};

// The rest pose of a person, to which joint angles apply.
//
// It faces +z with y up, in a T pose: legs hang, limbs that start sideways are stretched out, the
// head is upright. Bones from a branching joint keep their mean direction in the clip. Every bone
// has its median length in the clip.
struct Rig {
  std::vector<RigJoint> joints;  // depth first, the skeleton's root first
};

// Requires a clip with the skeleton's joints, at least one frame and finite positions.
Rig MakeRig(const motion::Skeleton& skeleton, const motion::Clip& clip);

// Gives the rig's bones the lengths that they have in one pose, in the same directions.
// Shapes: pose [skeleton joints]. Units: metres.
void SetBoneLengths(absl::Span<const motion::Vec3> pose, Rig* rig);

// One frame as angles: each joint's rotation relative to its parent's.
struct RigPose {
  Vec3d root_position;
  std::vector<Quaternion> rotations;  // [rig joints]
  // Each joint's offset from its parent, in the parent's axes; for the root, its position.
  std::vector<Vec3d> translations;  // [rig joints]
};

// The treatment of captured bones, which change their lengths.
enum class BoneLengths {
  kRigs,     // every bone as long as the rig's: joints may be off
  kCaptured  // joints keep their captured positions: translations differ from the rig's offsets
};

// Converts joint positions to joint angles, frame by frame. Angles that a frame does not define
// (the twist of a straight arm) keep their previous value.
//
// Branching joints are rotated by Kabsch's fit over their neighbours. Every other joint is placed
// first and then points at its child, so that varying bone lengths of a capture do not accumulate
// along a limb. The plane of the elbow or knee defines the twist of the upper limb. A nearly
// straight limb keeps its plane; no bone turns about itself faster than kMaxTwist and
// kMaxTwistSpeed, and slower where a joint at one of its ends would turn faster than kMaxTurnSpeed
// against its parent. That moves no joint.
class PoseFitter {
 public:
  // Degrees per frame, and degrees per second.
  static constexpr double kMaxTwist = 40, kMaxTwistSpeed = 600;
  // Degrees per second.
  static constexpr double kMaxTurnSpeed = 850;

  // `rig` must outlive the fitter.
  PoseFitter(const Rig& rig, double frame_rate_hz, BoneLengths lengths = BoneLengths::kRigs);
  // positions: [skeleton joints], metres.
  const RigPose& Fit(absl::Span<const motion::Vec3> positions);

 private:
  Quaternion FitAim(const RigJoint& joint, Vec3d stands_at, Quaternion to_parent,
                    Quaternion previous, absl::Span<const motion::Vec3> positions) const;
  Quaternion FitBend(const RigJoint& joint, Vec3d direction, Vec3d next_bone, Quaternion swing,
                     Quaternion previous) const;
  // The rotation of rig joint j in the world, with its bone turned about itself from its direction
  // in the frame before no farther than it may.
  Quaternion LimitTwist(std::size_t j, Quaternion to_parent, Quaternion fit,
                        absl::Span<const motion::Vec3> positions) const;
  // How far rig joint j, and the one that it points at, turn against their parents; the larger.
  double LargestTurn(std::size_t j, Quaternion to_parent, Quaternion world, Vec3d next_bone) const;

  const Rig& rig_;
  const double max_twist_, max_turn_;  // per frame, radians
  const BoneLengths lengths_;
  bool first_ = true;
  RigPose pose_;
  std::vector<Quaternion> world_;  // the joints' rotations in the world. [rig joints]
  std::vector<int> aims_;          // the rig joint that a joint points at, or -1. [rig joints]
};

// Poses of a rig for files and engines, frame by frame: those of PoseFitter, with feet that stand
// level and turn no faster than kMaxFootSpeed, and with quaternions on the same side as in the
// frame before (q, not -q). A frame depends only on itself and earlier frames.
class RigFitter {
 public:
  // Degrees per second, of a foot without toes against its shin.
  static constexpr double kMaxFootSpeed = 700;

  // `rig` must outlive the fitter. `ankle_height_on_floor`: see AnkleHeightOnFloor.
  RigFitter(const motion::Skeleton& skeleton, const Rig& rig, double frame_rate_hz,
            double ankle_height_on_floor, BoneLengths lengths);
  // positions: [skeleton joints], metres, y up. The result is valid until the next call.
  const RigPose& Fit(absl::Span<const motion::Vec3> positions);

 private:
  void TurnFeet(const std::vector<Quaternion>& previous);

  const Rig& rig_;
  const double ankle_height_;
  const double max_foot_turn_;  // in a frame, radians
  std::vector<bool> feet_;      // whether a rig joint is a foot without toes
  PoseFitter fitter_;
  bool first_ = true;
  RigPose pose_;
};

// The positions of the rig's joints in a pose of its own bone lengths: forward kinematics. Ignores
// translations. [rig joints]
std::vector<Vec3d> JointPositions(const Rig& rig, const RigPose& pose);

// Poses of a rig in an endless motion, frame by frame: those of RigFitter, but a pose depends only
// on its frame's index and on the last HistoryFrames(). A fit that begins so many frames earlier,
// or at frame 0, continues with the same poses, bit for bit.
//
// Two fitters run at a time. Another one begins every second, its share grows during that second
// and falls during the next one. Both point every bone in its direction, so only the turns of bones
// about themselves are interpolated.
class EndlessRigFitter {
 public:
  // `rig` must outlive the fitter. `ankle_height_on_floor`: see AnkleHeightOnFloor.
  EndlessRigFitter(const motion::Skeleton& skeleton, const Rig& rig, double frame_rate_hz,
                   double ankle_height_on_floor);

  // Number of frames before a frame that its pose depends on.
  static int HistoryFrames(double frame_rate_hz);

  // Fits the frame after the last one; `frame` is its index in the motion, at least 0. positions:
  // [skeleton joints], metres, y up. A quaternion may differ in sign from that of the frame before.
  // The result is valid until the next call.
  const RigPose& Fit(int frame, absl::Span<const motion::Vec3> positions);

 private:
  std::unique_ptr<RigFitter> NewFitter() const;

  const motion::Skeleton skeleton_;
  const Rig& rig_;
  const double frame_rate_hz_, ankle_height_;
  const int block_;  // frames
  std::unique_ptr<RigFitter> older_, younger_;
  RigPose pose_;
};

// A person for formats with an animated hierarchy: a rig at rest, and rotations and translations of
// its joints. Every joint of the skeleton is exactly at its position in the clip.
struct RigAnimation {
  Rig rig;
  // In the rest pose, which stands on the floor at the origin. [rig joints]
  std::vector<Vec3d> rest_positions;
  double frame_rate_hz = 0;
  double sole_depth = kUsualAnkleHeight;  // below the ankles, metres
  std::vector<RigPose> frames;  // rotations of neighbouring frames are on the same side (q, not -q)

  // A joint's offset from its parent at rest; for the root, its position.
  Vec3d RestTranslation(std::size_t joint) const;
  // Whether a joint keeps its offset from its parent in all frames, up to rounding. Bones of
  // constant length need no translations.
  bool KeepsItsPlace(std::size_t joint) const;
  // Whether a joint never rotates relative to its parent.
  bool NeverTurns(std::size_t joint) const;
};

// A skeleton without toes does not define the rotation of feet: they follow the shin, and are level
// when they stand.
//
// Requires a clip with the skeleton's joints, at least one frame and finite positions. Units:
// metres, y up.
RigAnimation AnimateRig(const motion::Skeleton& skeleton, const motion::Clip& clip);

// The rest positions of a rig's joints, with the lowest at y = 0 and the root above the origin.
// [rig joints]
std::vector<Vec3d> RestPositions(const Rig& rig);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_FITTING_H_
