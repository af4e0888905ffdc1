#include "model/evaluation/experiments/long_leaders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/engine/cross_fade.h"
#include "model/evaluation/experiments/made_body.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::experiments {
namespace {

constexpr float kFollowerDistance = 1;
constexpr double kFadeSeconds = 0.5;

float Wave(double amplitude, double seconds, double period) {
  return static_cast<float>(amplitude * std::sin(2 * M_PI * seconds / period));
}

// The place and direction of a body.
struct Place {
  motion::Vec3 at;
  double yaw = 0;
};
using PlaceAt = Place (*)(double seconds);

// Steps that keep the feet under a moving body: a foot stands for three fifths of a cycle where the
// body passes over it in the middle of that time, and swings to its next stand for the rest.
struct Gait {
  double cycle_seconds;
  double lift_metres;
};
constexpr double kStance = 0.6;

motion::Vec3 Stand(const Place& place, float side) {
  return place.at + RotateY(motion::Vec3{side * kHalfStance, 0, 0}, place.yaw);
}

motion::Vec3 FootAt(const Gait& gait, PlaceAt place, double seconds, float side) {
  const double offset = side < 0 ? 0 : 0.5;
  const double cycle = seconds / gait.cycle_seconds + offset;
  const double first = std::floor(cycle), phase = cycle - first;
  const auto stand = [&](double number) {
    return Stand(place((number + kStance / 2 - offset) * gait.cycle_seconds), side);
  };
  if (phase < kStance) return stand(first);
  const double way = (phase - kStance) / (1 - kStance);
  const double smooth = way * way * (3 - 2 * way);
  motion::Vec3 foot = Lerp(stand(first), stand(first + 1), static_cast<float>(smooth));
  foot.y = static_cast<float>(gait.lift_metres * std::sin(M_PI * way));
  return foot;
}

MadeBody Standing() {
  MadeBody body;
  body.hips = {0, kStandingHips, 0};
  body.left_foot = Stand({}, -1);
  body.right_foot = Stand({}, 1);
  return body;
}

MadeBody Stepping(const Gait& gait, PlaceAt place, double seconds) {
  const Place now = place(seconds);
  MadeBody body;
  body.hips = now.at + motion::Vec3{0, kStandingHips - 0.03f, 0};
  body.hips.y += Wave(0.015, seconds, gait.cycle_seconds / 2);
  body.yaw = now.yaw;
  body.left_foot = FootAt(gait, place, seconds, -1);
  body.right_foot = FootAt(gait, place, seconds, 1);
  return body;
}

MadeBody Idle(double seconds) {
  MadeBody body = Standing();
  body.hips += motion::Vec3{Wave(0.03, seconds, 4.1), Wave(0.005, seconds, 3), 0};
  body.yaw = Wave(0.06, seconds, 7.3);
  body.bend = 0.03 + Wave(0.02, seconds, 5.2);
  body.left_arm.swing = Wave(0.08, seconds, 4.1);
  body.right_arm.swing = Wave(0.08, seconds, 4.7);
  return body;
}

// An eight of 3 m by 1.2 m every 14 s, half a metre a second and more.
Place EightPlace(double seconds) {
  const double turn = 2 * M_PI * seconds / 14;
  const double x = 1.5 * std::sin(turn), z = -0.6 * std::sin(2 * turn);
  const double along_x = 1.5 * std::cos(turn), along_z = -1.2 * std::cos(2 * turn);
  return {{static_cast<float>(x), 0, static_cast<float>(z)}, std::atan2(-along_x, -along_z)};
}

MadeBody WalkEight(double seconds) {
  const Gait gait = {1.1, 0.12};
  MadeBody body = Stepping(gait, EightPlace, seconds);
  body.bend = 0.05;
  body.left_arm.swing = Wave(0.45, seconds, gait.cycle_seconds);
  body.right_arm.swing = -body.left_arm.swing;
  return body;
}

Place DancePlace(double seconds) {
  return {{Wave(0.25, seconds, 4), 0, Wave(0.1, seconds, 8)}, Wave(0.5, seconds, 12)};
}

MadeBody Dance(double seconds) {
  MadeBody body = Stepping({1, 0.15}, DancePlace, seconds);
  body.bend = Wave(0.12, seconds, 2);
  body.left_arm = {1.4 + Wave(1.1, seconds, 2), 0.5, 0.6 + Wave(0.5, seconds, 1)};
  body.right_arm = {1.4 - Wave(1.1, seconds, 2), 0.5, 0.6 - Wave(0.5, seconds, 1)};
  return body;
}

// Down within 10 s and up again.
MadeBody Sit(double seconds) {
  const double down = 0.5 - 0.5 * std::cos(2 * M_PI * seconds / 10);
  MadeBody body = Standing();
  body.hips += motion::Vec3{0, static_cast<float>(-0.36 * down), static_cast<float>(0.3 * down)};
  body.bend = 0.03 + 0.5 * std::sin(M_PI * down);
  body.left_arm.swing = body.right_arm.swing = 0.5 * down;
  body.left_arm.elbow = body.right_arm.elbow = 0.25 + 0.8 * down;
  return body;
}

struct NamedMotion {
  const char* name;
  MadeBody (*at)(double seconds);
};
constexpr NamedMotion kMade[] = {
    {"idle", Idle}, {"walk_eight", WalkEight}, {"dance", Dance}, {"sit", Sit}};

int FrameCount(double seconds, double frame_rate_hz) {
  return static_cast<int>(std::lround(seconds * frame_rate_hz)) + 1;
}

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

dataset::Sequence MakeSequence(const dataset::Dataset& dataset, int interaction_class,
                               motion::Poses leader, motion::Poses first_pose) {
  dataset::Sequence sequence;
  sequence.interaction_class = interaction_class;
  sequence.pair.leader = {dataset.skeleton.joint_names, dataset.frame_rate_hz, std::move(leader)};
  sequence.pair.follower = {dataset.skeleton.joint_names, dataset.frame_rate_hz,
                            std::move(first_pose)};
  return sequence;
}

// Standing a metre in front of a leader who faces -z at the origin.
motion::Poses StandingFollower() {
  std::vector<motion::Vec3> pose = PoseOf(Standing());
  const int joints = static_cast<int>(pose.size());
  for (motion::Vec3& p : pose) p = RotateY(p, M_PI) + motion::Vec3{0, 0, -kFollowerDistance};
  return {joints, std::move(pose)};
}

// The class's clips that can be looped; the first of them determines the follower's place.
std::vector<const dataset::Sequence*> LoopableClips(const dataset::Dataset& dataset,
                                                    const std::vector<int>& sequences,
                                                    int interaction_class) {
  std::vector<const dataset::Sequence*> clips;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class == interaction_class && IsLoopable(sequence)) {
      clips.push_back(&sequence);
    }
  }
  return clips;
}

}  // namespace

const std::vector<std::string>& MadeLeaderNames() {
  static const auto& names = *[] {
    auto* all = new std::vector<std::string>;
    for (const NamedMotion& made : kMade) all->push_back(made.name);
    return all;
  }();
  return names;
}

motion::Poses MakeLeader(const std::string& name, double seconds, double frame_rate_hz) {
  const auto* made = std::find_if(std::begin(kMade), std::end(kMade),
                                  [&](const NamedMotion& other) { return name == other.name; });
  motion::Poses poses(0, motion::SbuSkeleton().joint_count());
  for (int t = 0; t < FrameCount(seconds, frame_rate_hz); ++t) {
    poses.Append(PoseOf(made->at(t / frame_rate_hz)));
  }
  return poses;
}

motion::Poses LoopClips(const motion::Skeleton& skeleton, const std::vector<motion::Poses>& clips,
                        double seconds, double frame_rate_hz) {
  const engine::CrossFade cross_fade(skeleton);
  const int frames = FrameCount(seconds, frame_rate_hz);
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

dataset::Sequence LoopTake(const dataset::Dataset& dataset, const dataset::Sequence& take,
                           double seconds) {
  dataset::Sequence looped = take;
  looped.pair.leader.poses =
      LoopClips(dataset.skeleton, {take.pair.leader.poses}, seconds, dataset.frame_rate_hz);
  looped.pair.follower.poses.Resize(1);
  looped.labels.clear();
  const int frames = looped.pair.leader.frame_count();
  const int step = take.pair.leader.frame_count() - FadeFrames(dataset.frame_rate_hz);
  for (int first = 0; first < frames; first += step) {
    for (const dataset::LabelSpan& span : take.labels) {
      const int begin = first + span.begin;
      const int end = std::min(first + std::min(span.end, step), frames);
      if (begin < end) looped.labels.push_back({span.interaction_class, begin, end});
    }
  }
  return looped;
}

std::vector<LongLeader> MakeLongLeaders(const dataset::Dataset& dataset,
                                        const std::vector<int>& sequences, int interaction_class,
                                        double seconds) {
  std::vector<LongLeader> leaders;
  if (dataset.skeleton.joint_names == motion::SbuSkeleton().joint_names) {
    for (const std::string& name : MadeLeaderNames()) {
      leaders.push_back({name, MakeSequence(dataset, interaction_class,
                                            MakeLeader(name, seconds, dataset.frame_rate_hz),
                                            StandingFollower())});
      leaders.back().sequence.partner_direction = motion::Vec3{0, 0, -1};
    }
  }
  const std::vector<const dataset::Sequence*> clips =
      LoopableClips(dataset, sequences, interaction_class);
  if (clips.empty()) return leaders;
  std::vector<motion::Poses> poses;
  for (const dataset::Sequence* clip : clips) poses.push_back(clip->pair.leader.poses);
  motion::Poses first_pose = clips.front()->pair.follower.poses;
  first_pose.Resize(1);
  leaders.push_back(
      {"captured", MakeSequence(dataset, interaction_class,
                                LoopClips(dataset.skeleton, poses, seconds, dataset.frame_rate_hz),
                                std::move(first_pose))});
  leaders.back().sequence.partner_direction = clips.front()->partner_direction;
  return leaders;
}

}  // namespace duet::evaluation::experiments
