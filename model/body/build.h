#ifndef DUET_MODEL_BODY_BUILD_H_
#define DUET_MODEL_BODY_BUILD_H_

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::body {

// Whether somebody looks like a person with a pelvis and two legs.
struct BuildFigures {
  // The width of the hips in any frame, as a share of their median width.
  double narrowest_hips = 1;
  double widest_hips = 1;
  double knee_degrees = 0;   // mean bend of both knees
  double hips_over_leg = 0;  // mean height of the hips above the lower foot, in lengths of the leg

  // How far the hips are from their width at most: 0 for a rigid pelvis.
  double HipsOff() const;
};

// Requires hips, feet and two legs of two bones, and at least one frame. World metres, y up.
BuildFigures MeasureBuild(const motion::Skeleton& skeleton, const Body& body,
                          const motion::Poses& person);

// Whether somebody stands like a person who has nothing to do.
struct StillnessFigures {
  double joint_speed = 0;         // m/s, mean over joints and frames, after the noise filter
  double hand_over_shoulder = 0;  // share of frames with a hand above its shoulder
  double feet_apart = 0;          // metres along the floor, 90 % quantile over the frames
};

// Requires feet and two arms, and at least one frame. World metres, y up.
StillnessFigures MeasureStillness(const motion::Skeleton& skeleton, const Body& body,
                                  const motion::Poses& person, double frame_rate_hz);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_BUILD_H_
