
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/angle.h"
#include "model/engine/network_synthesizer.h"
#include "model/engine/windows.h"
#include "model/motion/filter.h"
#include "model/motion/posture.h"
#include "model/motion/resample.h"
#include "model/motion/standardise.h"
#include "model/training/augment.h"
#include "model/training/sampler.h"

namespace duet::training {
namespace {

using motion::Poses;
using motion::Vec3;

// A follower does not copy every shake of the leader's root and hips, and a shake is no action.
constexpr double kSmoothingSeconds = 0.3;
// Turning points of a borrowed reaction are rounded by a Gaussian of this deviation, seconds.
constexpr double kRoundingSeconds = 0.1;
// How a follower walks around a leader who turns: it takes so long to get in front of the leader,
// and it never walks faster than this around the leader, radians per second.
constexpr double kTurnSeconds = 1.5, kFastestTurn = 0.6;
// The share of the frames in which the lower foot is below the floor.
constexpr double kFloorShare = 0.25;

int LongestOf(const dataset::Dataset& dataset) {
  int longest = 0;
  for (const dataset::LoneLeader& leader : dataset.lone_leaders) {
    longest = std::max(longest, leader.poses.frame_count());
  }
  return longest;
}

Poses Smooth(const Poses& poses, double frame_rate_hz) {
  return motion::GaussianFilter(poses, kSmoothingSeconds * frame_rate_hz);
}

// One joint as a motion of its own.
Poses JointAlone(const Poses& poses, int joint) {
  Poses alone(poses.frame_count(), 1);
  for (int t = 0; t < poses.frame_count(); ++t) alone.at(t, 0) = poses.at(t, joint);
  return alone;
}

// Where a person faces in every frame, as the yaw that takes it to -z.
std::vector<double> FacingYaws(const motion::Skeleton& skeleton, const Poses& poses,
                               double frame_rate_hz) {
  Poses facing(poses.frame_count(), 1);
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 right = poses.at(t, skeleton.hips->right) - poses.at(t, skeleton.hips->left);
    facing.at(t, 0) = Cross({0, 1, 0}, right);
  }
  const Poses smooth = Smooth(facing, frame_rate_hz);
  std::vector<double> yaws;
  for (const Vec3& direction : smooth.all()) yaws.push_back(motion::FacingYaw(direction));
  return yaws;
}

// The direction of a follower who tries to be in front of a person who faces `facing`.
std::vector<double> FollowTurns(const std::vector<double>& facing, double frame_rate_hz) {
  std::vector<double> yaws = {facing.front()};
  const double most = kFastestTurn / frame_rate_hz;
  for (std::size_t t = 1; t < facing.size(); ++t) {
    const double behind = std::remainder(facing[t] - yaws.back(), 2 * base::kPi);
    const double turned = behind / (kTurnSeconds * frame_rate_hz);
    yaws.push_back(yaws.back() + std::clamp(turned, -most, most));
  }
  return yaws;
}

float FloorOf(const motion::Skeleton& skeleton, const Poses& poses) {
  const std::vector<Vec3> feet = LowerFeet(skeleton, poses);
  return feet.empty() ? 0 : motion::HeightQuantile(feet, kFloorShare);
}

// The frame that a follower's place and direction refer to, in every frame of a leader.
struct Place {
  std::vector<Vec3> origins;  // the leader's root without shakes, on the floor
  std::vector<double> yaws;
};

std::vector<Vec3> Origins(const motion::Skeleton& skeleton, const Poses& leader,
                          double frame_rate_hz) {
  const float floor = FloorOf(skeleton, leader);
  const Poses roots = Smooth(JointAlone(leader, skeleton.root), frame_rate_hz);
  std::vector<Vec3> origins;
  for (const Vec3& root : roots.all()) origins.push_back({root.x, floor, root.z});
  return origins;
}

// A captured leader; its follower's direction is the one that the capture states, or else that of
// the leader's hips in the first frame.
Place CapturedPlace(const dataset::Dataset& dataset, const dataset::Sequence& sequence) {
  const motion::Clip& leader = sequence.pair.leader;
  engine::SynthesisWindow window;
  window.leader = leader.poses;
  window.partner_direction = sequence.partner_direction;
  const double yaw = WindowStandardisation(dataset.skeleton, window).yaw();
  return {Origins(dataset.skeleton, leader.poses, dataset.frame_rate_hz),
          std::vector<double>(static_cast<std::size_t>(leader.frame_count()), yaw)};
}

// Draws a leader of at least `frames` frames.
const Poses* DrawLeader(const dataset::Dataset& dataset, int frames, base::Random* random) {
  std::vector<const Poses*> long_enough;
  for (const dataset::LoneLeader& leader : dataset.lone_leaders) {
    if (leader.poses.frame_count() >= frames) long_enough.push_back(&leader.poses);
  }
  if (long_enough.empty()) return nullptr;
  const auto count = static_cast<int64_t>(long_enough.size());
  return long_enough[static_cast<std::size_t>(random->Below(count))];
}

// Points and poses at other times, in frames.
std::vector<Vec3> At(const std::vector<double>& frames, const std::vector<Vec3>& points) {
  std::vector<Vec3> sampled;
  for (const double frame : frames) {
    const auto before = static_cast<std::size_t>(frame);
    const std::size_t after = std::min(before + 1, points.size() - 1);
    sampled.push_back(Lerp(points[before], points[after],
                           static_cast<float>(frame - static_cast<double>(before))));
  }
  return sampled;
}
Poses At(const std::vector<double>& frames, const Poses& poses) {
  Poses sampled(static_cast<int>(frames.size()), poses.joint_count());
  for (std::size_t t = 0; t < frames.size(); ++t) {
    SampleLinear(poses, frames[t], sampled[static_cast<int>(t)]);
  }
  return sampled;
}

// The follower at its place `from`, moved to `to`, frame by frame from `first` on.
Poses Carry(const Place& from, const Place& to, int first, const Poses& follower) {
  Poses carried = follower;
  for (int t = 0; t < carried.frame_count(); ++t) {
    const auto f = static_cast<std::size_t>(t), n = static_cast<std::size_t>(first + t);
    for (Vec3& point : carried[t]) {
      point = to.origins[n] + RotateY(point - from.origins[f], from.yaws[f] - to.yaws[n]);
    }
  }
  return carried;
}

// The follower of a sequence as a server would return it.
void FinishFollower(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                    base::Random* random, dataset::Sequence* sequence) {
  engine::SynthesisWindow window =
      MakeWindow(dataset, CapturedExample(dataset, *sequence, StartKnowledge::kPose));
  window.labels = DrawFrameLabels(*sequence, dataset.class_count(), {}, random);
  std::vector<engine::WindowResult> finished =
      FinishMotions(model, {window}, {sequence->pair.follower.poses});
  if (finished.front().ok()) sequence->pair.follower.poses = *std::move(finished.front());
}

}  // namespace

absl::Status CheckLoneLeaders(const TrainingOptions& options, const dataset::Dataset& dataset) {
  const double share = FlowIn(options) == nullptr ? 0 : FlowIn(options)->leaders.share;
  if (share == 0 && dataset.lone_leaders.empty()) return absl::OkStatus();
  if (dataset.lone_leaders.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "leaders.share: expected 0 without motions of leaders (--leaders), got ", share));
  }
  if (share == 0) {
    return absl::InvalidArgumentError(
        "leaders.share: expected a share above 0 of the clips of a sampling generator for the "
        "motions of leaders (--leaders), got 0");
  }
  if (!dataset.skeleton.hips) {
    return absl::InvalidArgumentError(
        "leaders.share: expected a skeleton with hips, which show where a leader faces, got none");
  }
  const int longest = LongestOf(dataset), needed = dataset.LongestFrameCount();
  if (longest >= needed) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("leaders: expected a motion of at least %.2f s, as long as the longest clip "
                      "of the data, got at most %.2f s",
                      needed / dataset.frame_rate_hz, longest / dataset.frame_rate_hz));
}

void ReplaceLeader(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                   const TrainingOptions::Augmentation& options, base::Random* random,
                   dataset::Sequence* sequence) {
  const motion::Skeleton& skeleton = dataset.skeleton;
  const int frames = sequence->pair.leader.frame_count();
  const Poses* drawn = DrawLeader(dataset, frames, random);
  if (drawn == nullptr) return;
  Poses leader = *drawn;
  if (options.mirror > 0 && random->Chance(0.5)) Mirror(MirroredJoints(skeleton), &leader);
  const int first = static_cast<int>(random->Below(leader.frame_count() - frames + 1));

  const double rate = dataset.frame_rate_hz;
  Place from = CapturedPlace(dataset, *sequence);
  const Place to = {Origins(skeleton, leader, rate),
                    FollowTurns(FacingYaws(skeleton, leader, rate), rate)};
  motion::ClipPair& pair = sequence->pair;
  if (sequence->labels.empty()) {  // a take with labels on a time line keeps its time
    const std::vector<double> reached =
        ReactionFrames(ActingShares(leader, rate), first, frames, rate, random);
    from.origins = At(reached, from.origins);
    pair.follower.poses =
        motion::GaussianFilter(At(reached, pair.follower.poses), kRoundingSeconds * rate);
  }
  pair.follower.poses = Carry(from, to, first, pair.follower.poses);
  pair.leader.poses = motion::Part(leader, first, frames);
  if (sequence->partner_direction) {
    sequence->partner_direction =
        RotateY(Vec3{0, 0, -1}, -to.yaws[static_cast<std::size_t>(first)]);
  }
  FinishFollower(model, dataset, random, sequence);
  DisturbLeader(options, random, &pair.leader);
}

namespace {

// Mean speeds of the joints of a leader who rests, and of one who acts, metres per second.
constexpr double kRestingSpeed = 0.08, kActingSpeed = 0.2;
// The pace of the way back.
constexpr double kRecoveryPace = 0.7;
// A follower that has recovered goes through the first part of its motion, to and fro.
constexpr double kSwaySeconds = 0.4, kSwayPeriodSeconds = 5;
// The share of the followers that begin in the midst of the reaction.
constexpr double kMidstShare = 0.5;

}  // namespace

std::vector<double> ActingShares(const Poses& leader, double frame_rate_hz) {
  const Poses smooth = motion::GaussianFilter(leader, kSmoothingSeconds * frame_rate_hz);
  std::vector<double> shares;
  for (int t = 0; t < smooth.frame_count(); ++t) {
    const int next = std::min(t + 1, smooth.frame_count() - 1), last = std::max(next - 1, 0);
    double moved = 0;
    for (int j = 0; j < smooth.joint_count(); ++j) {
      moved += Distance(smooth.at(next, j), smooth.at(last, j));
    }
    const double speed = moved * frame_rate_hz / smooth.joint_count();
    shares.push_back(
        std::clamp((speed - kRestingSpeed) / (kActingSpeed - kRestingSpeed), 0.0, 1.0));
  }
  return shares;
}

std::vector<double> ReactionFrames(const std::vector<double>& acting_shares, int first, int frames,
                                   double frame_rate_hz, base::Random* random) {
  const double end = frames - 1;
  double at = random->Chance(kMidstShare) ? random->Uniform(0, end) : 0;
  double direction = 1;
  const double phase = random->Uniform(0, 2 * base::kPi);
  std::vector<double> reached;
  for (int t = 0; t < frames; ++t) {
    const double turn = phase + 2 * base::kPi * t / (kSwayPeriodSeconds * frame_rate_hz);
    const double sway = kSwaySeconds * frame_rate_hz * 0.5 * (1 - std::cos(turn));
    const double acts = acting_shares[static_cast<std::size_t>(first + t)];
    const double acting_pace = direction > 0 ? 1 : -kRecoveryPace;
    if (t > 0) at += acts * acting_pace - (1 - acts) * kRecoveryPace;
    if (at >= end) direction = -1;
    if (at <= sway) direction = 1;
    at = std::clamp(at, std::min(sway, end), end);
    reached.push_back(at);
  }
  return reached;
}

}  // namespace duet::training
