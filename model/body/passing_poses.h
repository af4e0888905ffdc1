#ifndef DUET_MODEL_BODY_PASSING_POSES_H_
#define DUET_MODEL_BODY_PASSING_POSES_H_

#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// Poses that people pass through, but do not keep. Metres, y up; floors are horizontal.
namespace duet::body {

// From one foot to the other, along the floor. Requires two legs. Shapes: pose [joints].
motion::Vec3 Stride(const Body& body, absl::Span<const motion::Vec3> pose);

// Whether the feet are farther apart along the floor than 0.75 lengths of the leg. False without
// two legs. Shapes: pose [joints].
bool IsAstride(const Body& body, absl::Span<const motion::Vec3> pose);

// Whether a hand is held out: higher than 0.3 lengths of the arm below its shoulder, reaching for
// the partner by less than 0.4 of them (ReachTowards), and farther than 0.35 m from the partner's
// hands. Shapes: partner like pose, [joints].
bool IsHeldOut(const Body& body, const Limb& arm, int root, absl::Span<const motion::Vec3> partner,
               absl::Span<const motion::Vec3> pose);

// The longest time for which poses last, in seconds.
struct PoseSeconds {
  double astride = 0;
  double held_out = 0;  // of any hand
};

// Measures it, frame by frame.
class LongestPoses {
 public:
  // Both must outlive it.
  LongestPoses(const motion::Skeleton& skeleton, const Body& body);

  // Shapes: partner like pose, [joints].
  void Add(absl::Span<const motion::Vec3> partner, absl::Span<const motion::Vec3> pose);
  PoseSeconds Get(double frame_rate_hz) const;

 private:
  const motion::Skeleton& skeleton_;
  const Body& body_;
  int astride_ = 0, longest_astride_ = 0;  // frames
  std::vector<int> held_out_;              // frames, [arms]
  int longest_held_out_ = 0;
};

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_PASSING_POSES_H_
