#include "model/evaluation/experiments/looped_leaders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "model/authoring/made_leaders.h"
#include "model/engine/cross_fade.h"
#include "model/motion/resample.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::experiments {
namespace {

constexpr float kFollowerDistance = 1;
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

// A leader of a class in the data set's joints; the follower has only the first pose.
dataset::Sequence MakeSequence(const dataset::Dataset& dataset, int interaction_class,
                               std::string name, motion::Poses leader,
                               const motion::Poses& follower,
                               std::optional<motion::Vec3> partner_direction) {
  dataset::Sequence sequence;
  sequence.id = std::move(name);
  sequence.interaction_class = interaction_class;
  sequence.partner_direction = partner_direction;
  sequence.pair.leader = {dataset.skeleton.joint_names, dataset.frame_rate_hz, std::move(leader)};
  sequence.pair.follower = {dataset.skeleton.joint_names, dataset.frame_rate_hz,
                            motion::Part(follower, 0, 1)};
  return sequence;
}

// Standing a metre in front of a leader who faces -z at the origin.
motion::Poses StandingFollower() {
  motion::Poses follower = authoring::StandingPerson();
  for (motion::Vec3& p : follower.all()) {
    p = RotateY(p, M_PI) + motion::Vec3{0, 0, -kFollowerDistance};
  }
  return follower;
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

std::vector<dataset::Sequence> MakeLongLeaders(const dataset::Dataset& dataset,
                                               const std::vector<int>& sequences,
                                               int interaction_class, double seconds) {
  std::vector<dataset::Sequence> leaders;
  if (dataset.skeleton.joint_names == motion::SbuSkeleton().joint_names) {
    for (const char* const name : authoring::kMadeLeaders) {
      leaders.push_back(MakeSequence(dataset, interaction_class, name,
                                     authoring::MakeLeader(name, seconds, dataset.frame_rate_hz),
                                     StandingFollower(), motion::Vec3{0, 0, -1}));
    }
  }
  const dataset::Sequence* first = nullptr;  // determines the follower's place
  std::vector<motion::Poses> clips;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class != interaction_class || !IsLoopable(sequence)) continue;
    if (first == nullptr) first = &sequence;
    clips.push_back(sequence.pair.leader.poses);
  }
  if (first == nullptr) return leaders;
  leaders.push_back(MakeSequence(dataset, interaction_class, "captured",
                                 LoopClips(dataset.skeleton, clips, seconds, dataset.frame_rate_hz),
                                 first->pair.follower.poses, first->partner_direction));
  return leaders;
}

}  // namespace duet::evaluation::experiments
