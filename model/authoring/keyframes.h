#ifndef DUET_MODEL_AUTHORING_KEYFRAMES_H_
#define DUET_MODEL_AUTHORING_KEYFRAMES_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"

namespace duet::authoring {

// Parses a motion of one person from handwritten key poses, for samples and tests:
//
//   frame_rate 30           # optional; the default is 30
//   at 0                    # seconds, increasing; the last time ends the motion
//     torso 0 1.1 0         # metres: x to the left, y up, z forwards, floor at 0
//     chest 0 5 0           # degrees: yaw left, pitch forwards, roll left
//     left_foot 0.12 0.08 0 # the ankle
//   at 0.6
//     right_hand -0.1 -0.2 0.4   # the wrist, from the neck
//     right_elbow 20             # degrees outwards from its natural place
//
// Tracks: torso, pelvis, chest, head, left_foot, right_foot, left_hand, right_hand (three values),
// left_elbow, right_elbow, left_knee, right_knee (one). A track passes smoothly through its keys
// and never overshoots them. A track without keys keeps the value of a relaxed stand. '#' starts a
// comment.
//
// Returns the joints of SbuSkeleton, facing +z. At most a minute.
// Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ...".
absl::StatusOr<motion::Clip> ParseKeyframes(absl::string_view text, absl::string_view source);

}  // namespace duet::authoring

#endif  // DUET_MODEL_AUTHORING_KEYFRAMES_H_
