#ifndef DUET_MODEL_CLEANUP_DIRECTIONS_H_
#define DUET_MODEL_CLEANUP_DIRECTIONS_H_

#include "model/motion/vec3.h"

namespace duet::cleanup {

// The lengths below which a vector has no direction of its own: rounding would decide it.
// Metres, or a sine: within a person, and between points that touch.
inline constexpr float kNoDirection = 1e-4f;
// Metres: from a person, or a person's hand or foot, to the other person.
inline constexpr float kNoOffset = 1e-3f;

// `v` along the floor.
inline motion::Vec3 Level(motion::Vec3 v) { return {v.x, 0, v.z}; }

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_DIRECTIONS_H_
