#ifndef DUET_MODEL_ENGINE_CLIP_GRADER_H_
#define DUET_MODEL_ENGINE_CLIP_GRADER_H_

#include <memory>

#include "model/body/grade.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Grades a follower part by part, as its frames become final.
//
// Cost:    linear in the frames; keeps one frame.
// Threads: not safe to call concurrently.
class ClipGrader {
 public:
  // Null if the skeleton lacks joints that the grade needs (body::PairMeter). Requires a skeleton
  // that Validate accepts.
  static std::unique_ptr<ClipGrader> Create(const motion::Skeleton& skeleton, double frame_rate_hz);

  // The meter refers to the members before it.
  ClipGrader(const ClipGrader&) = delete;
  ClipGrader& operator=(const ClipGrader&) = delete;

  // Adds the frames of the follower after those added before. `leader`: the whole clip. Shapes:
  // leader [all frames, joints]; follower [frames, joints].
  void Add(const motion::Poses& leader, const motion::Poses& follower);
  // Requires at least one frame.
  body::Grade Get() const { return sum_.Get(); }

 private:
  ClipGrader(const motion::Skeleton& skeleton, body::Body body, double frame_rate_hz);

  const motion::Skeleton skeleton_;
  const body::Body body_;
  body::PairMeter meter_;
  body::GradeSum sum_;
  int frames_ = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CLIP_GRADER_H_
