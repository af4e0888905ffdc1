#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/body/limbs.h"
#include "model/motion/limb_lengths.h"
#include "model/motion/resample.h"
#include "model/training/augment.h"

namespace duet::training {
namespace {

using motion::Poses;
using motion::Vec3;
using Pose = std::vector<Vec3>;

// Pauses: the share of reactions that have one, and its length in seconds.
constexpr double kBeforeShare = 0.6, kShortestBefore = 0.13, kLongestBefore = 1.33;
constexpr double kAfterShare = 0.8, kShortestAfter = 0.27, kLongestAfter = 1.47;
// Half of the reactions with pauses are played faster or slower by up to this exponent.
constexpr double kWarpShare = 0.5, kWarp = 0.22;
// A movement that ends goes on in its direction for about this time, seconds.
constexpr double kCoastSeconds = 0.15;
// The way to rest begins after a moment and takes a moment, or longer at this speed. Seconds, m/s.
constexpr double kShortestWait = 0.2, kLongestWait = 0.8;
constexpr double kShortestWay = 0.7, kLongestWay = 1.3, kWaySpeed = 0.6;
constexpr float kStepHeight = 0.25f, kHighestStep = 0.06f;  // of the step's length; metres
// Shifts of weight: deviation in metres, periods in seconds.
constexpr double kSway = 0.015, kShortestSway = 3, kLongestSway = 7;
constexpr double kSwayEaseSeconds = 0.5;
// Of the leaders: how many shift their weight at rest, and go to rest or slow down after acting.
constexpr double kLeaderSways = 0.5, kLeaderRests = 0.4, kLeaderSlows = 0.3;
// The share of resting followers that begin in the midst of the reaction.
constexpr double kMidstShare = 0.5;
// Earlier poses are preferred as the pose of rest: a clip's last pose counts so much less calm.
constexpr double kLaterCost = 0.2;

double Smooth(double share) {
  share = std::clamp(share, 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

Vec3 Along(Vec3 v) { return {v.x, 0, v.z}; }

// A slow shift of the weight between feet that stand.
class Sway {
 public:
  Sway(const motion::Skeleton& skeleton, double deviation, base::Random* random)
      : skeleton_(skeleton),
        side_{static_cast<float>(random->Normal(deviation)), 0,
              static_cast<float>(random->Normal(deviation))},
        rate_(2 * base::kPi / random->Uniform(kShortestSway, kLongestSway)),
        phase_(random->Uniform(0, 2 * base::kPi)) {}

  // Moves the hips and all above them by the full shift, feet not at all. `share` of it, in [0, 1].
  void Apply(double seconds, double share, absl::Span<Vec3> pose) const {
    const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
    const float floor = std::min(at(skeleton_.feet->left).y, at(skeleton_.feet->right).y);
    const float hips = (at(skeleton_.hips->left).y + at(skeleton_.hips->right).y) / 2;
    const auto shift = static_cast<float>(share * std::sin(phase_ + rate_ * seconds));
    for (Vec3& joint : pose) {
      joint += side_ * (shift * std::clamp((joint.y - floor) / (hips - floor), 0.0f, 1.0f));
    }
  }

 private:
  const motion::Skeleton& skeleton_;
  Vec3 side_;
  double rate_, phase_;
};

// A captured person and what it does before, after and instead of its captured motion.
class Person {
 public:
  Person(const motion::Skeleton& skeleton, const Poses& captured, double rate, double sway,
         base::Random* random)
      : skeleton_(skeleton),
        body_(body::FindBody(skeleton)),
        captured_(captured),
        rate_(rate),
        sway_(skeleton, sway, random),
        lengths_(MedianBoneLengths(skeleton, captured)) {
    rest_ = CalmestPose();
    const auto root = static_cast<std::size_t>(skeleton.root);
    MoveRest(Along(captured.at(0, skeleton.root) - rest_[root]));
    wait_ = random->Uniform(kShortestWait, kLongestWait);
    way_ = random->Uniform(kShortestWay, kLongestWay);
    left_first_ = random->Chance(0.5);
  }

  int frames() const { return captured_.frame_count(); }
  Vec3 Root(int frame) const { return captured_.at(frame, skeleton_.root); }
  void MoveRest(Vec3 by) {
    for (Vec3& joint : rest_) joint += by;
  }

  // The captured pose at a frame; before the first frame, that one with a shift of weight.
  void Captured(double frame, absl::Span<Vec3> pose) const {
    SampleLinear(captured_, frame, pose);
    const double before = -frame / rate_;
    if (before > 0) sway_.Apply(-before, std::min(1.0, before / kSwayEaseSeconds), pose);
  }
  // At rest.
  void Resting(double seconds, absl::Span<Vec3> pose) const {
    std::copy(rest_.begin(), rest_.end(), pose.begin());
    sway_.Apply(seconds, 1, pose);
  }
  // `seconds` after the captured motion ended at a frame: the movement fades away.
  void Slowing(int end, double seconds, absl::Span<Vec3> pose) const {
    Moved(end, kCoastSeconds * (1 - std::exp(-seconds / kCoastSeconds)), pose);
  }
  // Likewise; the movement swings back, and then the person goes to rest.
  void GoingToRest(int end, double seconds, absl::Span<Vec3> pose) const {
    Moved(end, seconds * std::exp(-seconds / kCoastSeconds), pose);
    const Pose from(pose.begin(), pose.end());
    const auto root = static_cast<std::size_t>(skeleton_.root);
    const double way = std::max(way_, Norm(Along(rest_[root] - from[root])) / kWaySpeed);
    const double gone = (seconds - wait_) / way;
    const double share = Smooth(gone);
    for (std::size_t j = 0; j < pose.size(); ++j) {
      pose[j] = Lerp(from[j], rest_[j], static_cast<float>(share));
    }
    SetLengths(pose);
    for (std::size_t leg = 0; leg < body_.legs.size(); ++leg) {
      const body::Limb& limb = body_.legs[leg];
      const auto foot = static_cast<std::size_t>(limb.end);
      const double begin = (leg == 0) == left_first_ ? 0 : 0.5;
      const auto stepped = static_cast<float>(Smooth((gone - begin) * 2));
      const float lift =
          std::min(kHighestStep, kStepHeight * Norm(Along(rest_[foot] - from[foot]))) *
          std::sin(static_cast<float>(base::kPi) * stepped);
      ReachBent(limb, Lerp(from[foot], rest_[foot], stepped) + Vec3{0, lift, 0},
                body::Facing(*skeleton_.hips, pose), pose);
    }
    sway_.Apply(seconds, share, pose);
  }

 private:
  // The pose of a frame, moved on for so long at the speed that it has there.
  void Moved(int frame, double seconds, absl::Span<Vec3> pose) const {
    const int before = std::max(0, frame - 2);
    const double frames = std::max(1, frame - before);
    for (int j = 0; j < captured_.joint_count(); ++j) {
      const Vec3 step = captured_.at(frame, j) - captured_.at(before, j);
      pose[static_cast<std::size_t>(j)] =
          captured_.at(frame, j) + step * static_cast<float>(seconds * rate_ / frames);
    }
    SetLengths(pose);
  }
  void SetLengths(absl::Span<Vec3> pose) const {
    Poses one(captured_.joint_count(), Pose(pose.begin(), pose.end()));
    SetBoneLengths(skeleton_, lengths_, &one);
    std::copy(one.all().begin(), one.all().end(), pose.begin());
  }
  // Hands low, feet together, rather early.
  Pose CalmestPose() const {
    int calmest = 0;
    double least = HUGE_VAL;
    for (int t = 0; t < frames(); ++t) {
      double cost = kLaterCost * t / frames();
      for (const body::Limb& arm : body_.arms) {
        cost += (captured_.at(t, arm.end).y - captured_.at(t, arm.upper).y) /
                LengthOf(arm, captured_[t]);
      }
      const Vec3 apart =
          captured_.at(t, skeleton_.feet->left) - captured_.at(t, skeleton_.feet->right);
      cost += Norm(Along(apart)) / LengthOf(body_.legs.front(), captured_[t]);
      if (cost < least) {
        least = cost;
        calmest = t;
      }
    }
    return {captured_[calmest].begin(), captured_[calmest].end()};
  }

  const motion::Skeleton& skeleton_;
  const body::Body body_;
  const Poses captured_;
  const double rate_;
  const Sway sway_;
  const std::vector<float> lengths_;
  Pose rest_;
  double wait_ = 0, way_ = 0;  // seconds
  bool left_first_ = false;
};

// What a leader does after its captured motion.
enum class Ending { kHolds, kSlows, kRests };

Ending DrawEnding(base::Random* random) {
  const double draw = random->Uniform();
  if (draw < kLeaderRests) return Ending::kRests;
  return draw < kLeaderRests + kLeaderSlows ? Ending::kSlows : Ending::kHolds;
}

// The frames of a clip in those of the capture: the first one, which may be before the capture,
// and how many of the capture's pass in one of the clip's.
struct Window {
  double first = 0;
  double pace = 1;
  int frames = 0;

  double At(int t) const { return first + t * pace; }
};

int DrawFrames(double shortest_seconds, double longest_seconds, double rate, base::Random* random) {
  return static_cast<int>(std::lround(random->Uniform(shortest_seconds, longest_seconds) * rate));
}

// The whole reaction with pauses.
Window DrawPauses(int captured, double rate, int most, base::Random* random) {
  Window window;
  if (random->Chance(kWarpShare)) window.pace = std::exp(random->Uniform(-kWarp, kWarp));
  const bool has_before = random->Chance(kBeforeShare), has_after = random->Chance(kAfterShare);
  int before = has_before ? DrawFrames(kShortestBefore, kLongestBefore, rate, random) : 0;
  int after = has_after ? DrawFrames(kShortestAfter, kLongestAfter, rate, random) : 0;
  const int acted = std::min(most, static_cast<int>(std::lround((captured - 1) / window.pace)) + 1);
  before = std::min(before, (most - acted + 1) / 2);
  after = std::min(after, most - acted - before);
  window.first = -before * window.pace;
  window.frames = before + acted + after;
  return window;
}

// A window that begins within the capture, not before `earliest`, and lasts longer than it.
Window DrawMidst(int earliest, int captured, int most, base::Random* random) {
  const int first = earliest + static_cast<int>(random->Below(captured - earliest));
  const int least = std::min(most, captured - first + most / 4);
  return {static_cast<double>(first), 1, least + static_cast<int>(random->Below(most - least + 1))};
}

enum class Kind { kPauses, kEnd, kMotionless, kUnlabelled, kCaptured };

Kind DrawKind(const FlowSettings::Stillness& options, base::Random* random) {
  double draw = random->Uniform();
  for (const auto& [kind, share] : {std::pair{Kind::kUnlabelled, options.unlabelled()},
                                    std::pair{Kind::kMotionless, options.motionless()},
                                    std::pair{Kind::kEnd, options.ends()}}) {
    if (draw < share) return kind;
    draw -= share;
  }
  return random->Chance(options.pauses()) ? Kind::kPauses : Kind::kCaptured;
}

}  // namespace

absl::Status CheckStillness(const TrainingOptions& options, const dataset::Dataset& dataset) {
  const FlowSettings* flow = FlowIn(options);
  if (flow == nullptr || !UsesStillness(*flow)) return absl::OkStatus();
  const body::Body body = body::FindBody(dataset.skeleton);
  if (std::get<checkpoint::FlowArchitecture>(options.architecture).frame_labels) {
    return absl::InvalidArgumentError(
        "stillness: expected shares of 0 for a generator with frame_labels, got others");
  }
  if (dataset.skeleton.hips && dataset.skeleton.feet && body.legs.size() == 2 &&
      !body.arms.empty()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      "stillness: expected a skeleton with hips, two legs and arms, got one without");
}

StillClip AddStillness(const motion::Skeleton& skeleton, const FlowSettings::Stillness& options,
                       double frame_rate_hz, int most_frames, base::Random* random,
                       dataset::Sequence sequence) {
  StillClip clip;
  const Kind kind = DrawKind(options, random);
  motion::ClipPair& pair = sequence.pair;
  const int captured = pair.leader.frame_count(), last = captured - 1;
  Person follower(skeleton, pair.follower.poses, frame_rate_hz, kSway, random);
  const Person leader(skeleton, pair.leader.poses, frame_rate_hz,
                      random->Chance(kLeaderSways) ? kSway : 0, random);
  const Ending ending = DrawEnding(random);
  const bool rests = kind == Kind::kUnlabelled || kind == Kind::kMotionless;
  const bool midst = rests && random->Chance(kMidstShare);
  clip.amid = midst || kind == Kind::kEnd;
  const Window window =
      clip.amid ? DrawMidst(kind == Kind::kEnd ? captured / 2 : 0, captured, most_frames, random)
                : DrawPauses(captured, frame_rate_hz, most_frames, random);
  clip.unlabelled = kind == Kind::kUnlabelled;
  if (!rests) follower.MoveRest(Along(leader.Root(last) - leader.Root(0)));
  if (kind != Kind::kCaptured) {
    Poses led(window.frames, pair.leader.joint_count());
    Poses followed(window.frames, pair.leader.joint_count());
    for (int t = 0; t < window.frames; ++t) {
      const double at = window.At(t), seconds = t / frame_rate_hz;
      const double since = (at - last) / window.pace / frame_rate_hz;  // seconds after the end
      if (kind == Kind::kMotionless) {
        leader.Resting(seconds, led[t]);
      } else if (since <= 0 || ending == Ending::kHolds) {
        leader.Captured(at, led[t]);
      } else if (ending == Ending::kSlows) {
        leader.Slowing(last, since, led[t]);
      } else {
        leader.GoingToRest(last, since, led[t]);
      }
      if (midst) {
        follower.GoingToRest(static_cast<int>(window.first), seconds, followed[t]);
      } else if (rests) {
        follower.Resting(seconds, followed[t]);
      } else if (since <= 0) {
        follower.Captured(at, followed[t]);
      } else {
        follower.GoingToRest(last, since, followed[t]);
      }
    }
    pair.leader.poses = std::move(led);
    pair.follower.poses = std::move(followed);
  }
  clip.sequence = std::move(sequence);
  return clip;
}

}  // namespace duet::training
