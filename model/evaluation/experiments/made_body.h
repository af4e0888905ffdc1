#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_MADE_BODY_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_MADE_BODY_H_

#include <vector>

#include "model/motion/vec3.h"

namespace duet::evaluation::experiments {

// How an arm hangs from its shoulder, radians: forwards, sideways, and the elbow's bend.
struct MadeArm {
  double swing = 0, spread = 0.12, elbow = 0.25;
};

// The parameters of a body, which MakeLeader animates.
struct MadeBody {
  motion::Vec3 hips;  // the middle of both
  double yaw = 0;     // about +y; at 0 it faces -z
  double bend = 0;    // of the trunk, forwards, radians
  motion::Vec3 left_foot, right_foot;
  MadeArm left_arm, right_arm;
};

// Height of the middle of the hips with slightly bent knees, metres.
inline constexpr float kStandingHips = 0.80f;
// Distance of each foot from the middle.
inline constexpr float kHalfStance = 0.10f;

// The joints of SbuSkeleton. Limbs have constant lengths; a leg points towards a foot position out
// of reach.
std::vector<motion::Vec3> PoseOf(const MadeBody& body);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_MADE_BODY_H_
