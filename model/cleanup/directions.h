#ifndef DUET_MODEL_CLEANUP_DIRECTIONS_H_
#define DUET_MODEL_CLEANUP_DIRECTIONS_H_

// The lengths below which a vector has no direction of its own: rounding would decide it.
namespace duet::cleanup {

// Metres, or a sine: within a person, and between points that touch.
inline constexpr float kNoDirection = 1e-4f;
// Metres: from a person, or a person's hand or foot, to the other person.
inline constexpr float kNoOffset = 1e-3f;

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_DIRECTIONS_H_
