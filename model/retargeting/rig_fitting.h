#ifndef DUET_MODEL_RETARGETING_RIG_FITTING_H_
#define DUET_MODEL_RETARGETING_RIG_FITTING_H_

#include <memory>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/pose_fitting.h"
#include "model/retargeting/rig.h"

namespace duet::retargeting {

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

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_FITTING_H_
