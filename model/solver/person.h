#ifndef DUET_MODEL_SOLVER_PERSON_H_
#define DUET_MODEL_SOLVER_PERSON_H_

#include "absl/status/statusor.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::solver {

// The height at which a person's lower foot stands: the lower quartile over the frames, so that
// jumps and kicks do not count. Requires feet and at least one frame. Unit: metres.
double StandingHeight(const motion::Skeleton& skeleton, const motion::Poses& person);

// Turns a capture into the motion of a body, over the whole clip at once: constant bones, a rigid
// pelvis, rigid shoulders, feet that stand where they stand (feet.h). The height of the body
// follows from how far its legs are stretched in the capture, so that knees keep their bend. A
// smooth correction is added to the body's place and the pelvis rolls a little; trunk, head and
// hands keep their directions, their timing and their amplitude.
//
// `floor` is the height at which this person's feet shall stand, in the capture's world; the person
// is moved there.
// Errors: those of BodyModel::Measure. Shapes: returns the same frames and joints. Units: metres, y
// up.
absl::StatusOr<motion::Poses> SolvePerson(const motion::Skeleton& skeleton,
                                          const motion::Poses& person, double frame_rate_hz,
                                          double floor);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_PERSON_H_
