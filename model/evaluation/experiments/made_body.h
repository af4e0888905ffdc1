#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_MADE_BODY_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_MADE_BODY_H_

#include <vector>

#include "model/motion/vec3.h"

namespace duet::evaluation::experiments {

// How an arm hangs from its shoulder, radians: forwards, sideways, and the elbow's bend.
struct MadeArm {
  double swing = 0, spread = 0.12, elbow = 0.25;
};

// A body as few numbers: what MakeLeader moves.
struct MadeBody {
  motion::Vec3 hips;  // the middle of both
  double yaw = 0;     // about +y; at 0 it faces -z
  double bend = 0;    // of the trunk, forwards, radians
  motion::Vec3 left_foot, right_foot;
  MadeArm left_arm, right_arm;
};

// How high the middle of the hips is when the knees are a little bent, metres.
inline constexpr float kStandingHips = 0.80f;
// How far each foot stands from the middle.
inline constexpr float kHalfStance = 0.10f;

// The joints of SbuSkeleton. Limbs keep their lengths; a foot out of reach ends in its direction.
std::vector<motion::Vec3> PoseOf(const MadeBody& body);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_MADE_BODY_H_
