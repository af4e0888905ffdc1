#include "model/evaluation/experiments/looped_leaders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/authoring/made_leaders.h"
#include "model/engine/cross_fade.h"
#include "model/motion/resample.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kFadeSeconds = 0.5;

int FadeFrames(double frame_rate_hz) {
  return static_cast<int>(std::lround(kFadeSeconds * frame_rate_hz));
}

// Rotates and moves the clip on the floor to start as `first` does.
motion::Poses StartLike(const motion::Skeleton& skeleton, const motion::Poses& first,
                        motion::Poses clip) {
  const double turn = motion::Standardisation(skeleton, clip).yaw() -
                      motion::Standardisation(skeleton, first).yaw();
  const motion::Vec3 from = clip.at(0, skeleton.root);
  motion::Vec3 to = first.at(0, skeleton.root);
  to.y = from.y;
  for (motion::Vec3& p : clip.all()) p = RotateY(p - from, turn) + to;
  return clip;
}

}  // namespace

dataset::Sequence MakeLeaderSequence(const std::string& name, double seconds,
                                     double frame_rate_hz) {
  dataset::Sequence sequence;
  sequence.id = name;
  sequence.pair.leader = {motion::SbuSkeleton().joint_names, frame_rate_hz,
                          authoring::MakeLeader(name, seconds, frame_rate_hz)};
  return sequence;
}

motion::Poses LoopClips(const motion::Skeleton& skeleton, const std::vector<motion::Poses>& clips,
                        double seconds, double frame_rate_hz) {
  const engine::CrossFade cross_fade(skeleton);
  const int frames = static_cast<int>(std::lround(seconds * frame_rate_hz)) + 1;
  const int fade = FadeFrames(frame_rate_hz);
  motion::Poses looped = clips.front();
  for (size_t i = 1; looped.frame_count() < frames; ++i) {
    const motion::Poses next = StartLike(skeleton, clips.front(), clips[i % clips.size()]);
    cross_fade.Blend(next, looped.frame_count() - fade, &looped);
    looped.Append(next.frames(fade, next.frame_count() - fade));
  }
  looped.Resize(frames);
  return looped;
}

bool IsLoopable(const dataset::Sequence& take) {
  const motion::Clip& leader = take.pair.leader;
  return leader.frame_count() > 2 * kFadeSeconds * leader.frame_rate_hz;
}

int LoopFrames(const dataset::Dataset& dataset, const dataset::Sequence& take) {
  return take.pair.leader.frame_count() - FadeFrames(dataset.frame_rate_hz);
}

dataset::Sequence LoopTake(const dataset::Dataset& dataset, const dataset::Sequence& take,
                           double seconds) {
  dataset::Sequence looped = take;
  looped.pair.leader.poses =
      LoopClips(dataset.skeleton, {take.pair.leader.poses}, seconds, dataset.frame_rate_hz);
  looped.pair.follower.poses.Resize(1);
  looped.labels.clear();
  const int frames = looped.pair.leader.frame_count();
  const int step = LoopFrames(dataset, take);
  for (int first = 0; first < frames; first += step) {
    for (const dataset::LabelSpan& span : take.labels) {
      const int begin = first + span.begin;
      const int end = std::min(first + std::min(span.end, step), frames);
      if (begin < end) looped.labels.push_back({span.interaction_class, begin, end});
    }
  }
  return looped;
}

}  // namespace duet::evaluation::experiments
