#include "model/engine/clip_grader.h"

#include <utility>

namespace duet::engine {

std::unique_ptr<ClipGrader> ClipGrader::Create(const motion::Skeleton& skeleton,
                                               double frame_rate_hz) {
  body::Body body = body::FindBody(skeleton);
  if (!body::PairMeter::CanMeasure(skeleton, body)) return nullptr;
  return std::unique_ptr<ClipGrader>(new ClipGrader(skeleton, std::move(body), frame_rate_hz));
}

ClipGrader::ClipGrader(const motion::Skeleton& skeleton, body::Body body, double frame_rate_hz)
    : skeleton_(skeleton), body_(std::move(body)), meter_(skeleton_, body_, frame_rate_hz) {}

void ClipGrader::Add(const motion::Poses& leader, const motion::Poses& follower) {
  for (int t = 0; t < follower.frame_count(); ++t) {
    sum_.Add(meter_.Add(leader[frames_++], follower[t]));
  }
}

}  // namespace duet::engine
