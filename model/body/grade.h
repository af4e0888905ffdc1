#ifndef DUET_MODEL_BODY_GRADE_H_
#define DUET_MODEL_BODY_GRADE_H_

#include <optional>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// What a viewer would notice in a follower's motion. The same measures choose among samples, grade
// an answer and evaluate a model. World metres, y up.
namespace duet::body {

// The thresholds of a fault.
inline constexpr double kTwistDegrees = 45;           // between shoulders and hips
inline constexpr double kSkateMetresPerSecond = 0.1;  // of the slower ankle
inline constexpr double kHeadMetres = 0.18;           // between the two heads
inline constexpr double kTrunkMetres = 0.16;          // between the axes of the two trunks

// The measures of one frame.
struct FrameMeasures {
  double twist_degrees =
      0;             // between the lines of shoulders and hips, seen along the trunk; 0 to 180
  double skate = 0;  // speed of the slower ankle, m/s
  double leader_skate = 0;
  // By how much the heads and the trunks are nearer than they may be, metres; at least 0.
  double head_overlap = 0, trunk_overlap = 0;

  bool twisted() const { return twist_degrees > kTwistDegrees; }
  bool skates() const { return skate > kSkateMetresPerSecond; }
  bool leader_skates() const { return leader_skate > kSkateMetresPerSecond; }
  bool overlaps() const { return head_overlap > 0 || trunk_overlap > 0; }
};

// Measures consecutive frames of a pair, given in one or more calls.
//
// Cost:    linear in the frames; keeps one frame.
// Threads: not safe to call concurrently.
class PairMeter {
 public:
  // Whether a skeleton has the hips, feet, shoulders and chest that the measures need.
  static bool CanMeasure(const motion::Skeleton& skeleton, const Body& body);

  // Requires CanMeasure.
  PairMeter(motion::Skeleton skeleton, Body body, double frame_rate_hz)
      : skeleton_(std::move(skeleton)), body_(std::move(body)), frame_rate_hz_(frame_rate_hz) {}

  // The measures of the next frame. The first frame has no speeds. Shapes: leader, follower
  // [joints].
  FrameMeasures Add(absl::Span<const motion::Vec3> leader, absl::Span<const motion::Vec3> follower);

 private:
  struct Feet {
    motion::Vec3 left, right;
  };
  Feet FeetOf(absl::Span<const motion::Vec3> pose) const;
  double SlowerFoot(const Feet& before, const Feet& now) const;

  motion::Skeleton skeleton_;
  Body body_;
  double frame_rate_hz_;
  std::optional<Feet> leader_feet_, follower_feet_;  // of the last frame
};

// Consecutive frames [first, first + count).
struct FrameRun {
  int first = 0;
  int count = 0;
};

// The grade of a motion. Shares are of all its frames, 0 to 1.
struct Grade {
  double twisted = 0;
  double skating = 0;
  double leader_skating = 0;
  double overlapping = 0;
  std::vector<FrameRun> bad_runs;  // frames that are twisted or overlap; at most kMostRuns
};
inline constexpr int kMostRuns = 64;

// Collects the grade of a motion of any length, frame by frame.
class GradeSum {
 public:
  void Add(const FrameMeasures& frame);
  // Requires at least one frame.
  Grade Get() const;

 private:
  int frames_ = 0, twisted_ = 0, skating_ = 0, leader_skating_ = 0, overlapping_ = 0;
  std::vector<FrameRun> bad_runs_;
};

// The angle between the lines of shoulders and hips, seen along the trunk, from -180 to 180
// degrees: positive if the shoulders are turned to the left of the hips. 0 if a line has no
// direction. Requires hips, shoulders and chest. Shapes: pose [joints].
double TwistDegrees(const motion::Skeleton& skeleton, const Body& body,
                    absl::Span<const motion::Vec3> pose);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_GRADE_H_
