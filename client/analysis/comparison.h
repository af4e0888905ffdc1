#ifndef DUET_CLIENT_ANALYSIS_COMPARISON_H_
#define DUET_CLIENT_ANALYSIS_COMPARISON_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::analysis {

// One motion that is compared: a person, and the partner whom that person answers, where known.
struct Answer {
  motion::Clip person;
  std::optional<motion::Clip> partner;
};

// A figure of both motions. Absent where it cannot be taken: no partner, too few frames.
struct Figure {
  std::string group;  // "speed", "lean", "contact"
  std::string name;   // "joint_speed_metres_per_second": for programs, with its unit
  std::string title;  // "joint speed": for people
  std::string unit;   // "m/s"
  std::optional<double> a, b;
};

// How far b's person is from a's, over the time that both have. Metres; see
// evaluation::metrics for the definitions.
struct Displacement {
  double mean_metres = 0;          // over frames and joints
  double root_aligned_metres = 0;  // the same with the roots put together in every frame
  double root_metres = 0;          // the mean distance of the roots
  double most_metres = 0;          // of any joint in any frame
  std::string most_joint;
  int most_frame = 0;
  double velocity_metres_per_second = 0;  // the mean difference of joint velocities; 0 of one frame
  std::vector<double> joint_metres;       // the mean of each [joints]
};

struct Comparison {
  double frame_rate_hz = 0;  // at which both were compared
  int frame_count = 0;       // that both have
  bool resampled = false;    // b came at another rate
  Displacement displacement;
  // The mean distance of the partners' joints, where both have one: 0 for answers to the same
  // leader.
  std::optional<double> partner_metres;
  std::vector<Figure> figures;  // of each motion by itself, over its whole length
};

// Requires the skeleton's joints, frames and positive rates. Units: world metres, y up. Errors:
// INVALID_ARGUMENT where a partner has not its person's frames.
absl::StatusOr<Comparison> Compare(const Answer& a, const Answer& b,
                                   const motion::Skeleton& skeleton);

}  // namespace duet::client::analysis

#endif  // DUET_CLIENT_ANALYSIS_COMPARISON_H_
