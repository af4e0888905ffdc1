#ifndef DUET_MODEL_CLEANUP_LIVE_FRAME_H_
#define DUET_MODEL_CLEANUP_LIVE_FRAME_H_

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// Corrections of one frame that the caller gets. Clips use PlaceFeetBetween only; live sessions use
// all of them. Plans are corrected at the model's rate
// (LiveBounds); frames between two planned ones, and leaders who jump after a plan was made, need
// more.
//
// Shapes: poses [joints].

namespace duet::cleanup {

// Puts the feet of a frame between two planned ones where `interpolated` has them, at a height
// between those of the planned frames. Splines overshoot, and setting bone lengths from the root on
// moves feet: those of a body that turns around within a planned frame by up to 0.2 m.
void PlaceFeetBetween(const motion::Skeleton& skeleton, const body::Body& body,
                      absl::Span<const motion::Vec3> before, absl::Span<const motion::Vec3> after,
                      absl::Span<const motion::Vec3> interpolated, absl::Span<motion::Vec3> pose);

// Moves the body vertically, so that its lower foot is at `height` again: legs that SlowFrame holds
// back would leave it above or below the floor. Does nothing without two legs.
void KeepHeight(const body::Body& body, float height, absl::Span<motion::Vec3> pose);
// The height of the lower foot, metres; 0 without two legs.
float HeightOf(const body::Body& body, absl::Span<const motion::Vec3> pose);

// Moves a follower that stands in its leader along the floor, until their roots are 0.17 m apart.
void KeepApart(int root, absl::Span<const motion::Vec3> leader, absl::Span<motion::Vec3> follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LIVE_FRAME_H_
