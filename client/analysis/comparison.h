#ifndef DUET_CLIENT_ANALYSIS_COMPARISON_H_
#define DUET_CLIENT_ANALYSIS_COMPARISON_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::analysis {

// One motion of a comparison: a person, and the partner whom that person answers, if known.
struct Answer {
  motion::Clip person;
  std::optional<motion::Clip> partner;
};

// A figure of both motions. Absent if it cannot be computed: no partner, or too few frames.
struct Figure {
  std::string group;  // "speed", "lean", "contact"
  std::string name;   // for programs, with the unit: "joint_speed_metres_per_second"
  std::string title;  // for people: "joint speed"
  std::string unit;   // "m/s"
  std::optional<double> a, b;
};

// The distance of b's person from a's, over their common time. model/body has the
// definitions. Units: metres.
struct Displacement {
  double mean_metres = 0;          // over frames and joints
  double root_aligned_metres = 0;  // the same, with the roots aligned in every frame
  double root_metres = 0;          // the mean distance of the roots
  double most_metres = 0;          // the largest of any joint in any frame
  std::string most_joint;
  int most_frame = 0;
  double velocity_metres_per_second = 0;  // mean difference of joint velocities; 0 for one frame
  std::vector<double> joint_metres;       // the mean of each joint
};

struct Comparison {
  double frame_rate_hz = 0;  // of the comparison
  int frame_count = 0;       // of the common time
  bool resampled = false;    // b has another rate
  Displacement displacement;
  // Mean distance of the partners' joints, if both have a partner: 0 for answers to the same
  // leader.
  std::optional<double> partner_metres;
  std::vector<Figure> figures;  // of each motion, over its whole length
};

// Requires the skeleton's joints, frames and positive rates. Units: world metres, y up. Errors:
// INVALID_ARGUMENT if a partner and its person have different numbers of frames.
absl::StatusOr<Comparison> Compare(const Answer& a, const Answer& b,
                                   const motion::Skeleton& skeleton);

}  // namespace duet::client::analysis

#endif  // DUET_CLIENT_ANALYSIS_COMPARISON_H_
