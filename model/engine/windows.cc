#include "model/engine/windows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "model/base/split_mix.h"
#include "model/solver/geometry.h"

namespace duet::engine {
namespace {

// Below this share of the wanted length a blended bone has no direction to speak of.
constexpr float kLeastDirection = 0.1f;

motion::Vec3 BlendBone(motion::Vec3 a, motion::Vec3 b, float weight) {
  const motion::Vec3 average = Lerp(a, b, weight);
  const float length = Norm(average);
  const float wanted = Norm(a) + (Norm(b) - Norm(a)) * weight;
  return length > kLeastDirection * wanted ? average * (wanted / length) : average;
}

std::vector<motion::Bone> ParentsFirst(const motion::Skeleton& skeleton) {
  std::vector<motion::Bone> ordered;
  for (const int bone : BonesFromRoot(skeleton)) {
    ordered.push_back(skeleton.bones[static_cast<std::size_t>(bone)]);
  }
  return ordered;
}

// Lengths of clips and ways of joints that differ by less are mostly the same leader.
constexpr double kSeconds = 0.25;
constexpr double kMetres = 0.05;
constexpr uint64_t kSeeds = uint64_t{1} << 32;  // every number of JSON can hold them

// Closer than this the direction from root to root says little: people in a hug.
constexpr float kMinDistanceMetres = 0.3f;

}  // namespace

int CrossFadeOverlap(int window) { return std::max(1, window / 3); }

int SettledOverlap(int window) { return std::max(1, (window + 3) / 6); }

WindowPlan PlanWindows(int frames, int longest, int overlap) {
  if (frames <= longest) return {frames, {0}};
  const int step = longest - overlap;
  const int64_t last_start = frames - longest;
  const int64_t steps = (last_start + step - 1) / step;  // windows after the first
  WindowPlan plan{longest, {}};
  for (int64_t k = 0; k <= steps; ++k) {
    // Rounded to the nearest frame; never more than `step` apart, since step is whole.
    plan.starts.push_back(static_cast<int>((2 * k * last_start + steps) / (2 * steps)));
  }
  return plan;
}

CrossFade::CrossFade(const motion::Skeleton& skeleton)
    : root_(static_cast<std::size_t>(skeleton.root)), bones_(ParentsFirst(skeleton)) {}

void CrossFade::Blend(const motion::Poses& next, int first, motion::Poses* poses) const {
  const int frames = poses->frame_count() - first;
  for (int t = 0; t < frames; ++t) {
    const float weight =
        solver::SmoothStep(static_cast<float>(t + 1) / static_cast<float>(frames + 1));
    BlendPose(next[t], weight, (*poses)[first + t]);
  }
}

void CrossFade::BlendPose(absl::Span<const motion::Vec3> next, float weight,
                          absl::Span<motion::Vec3> pose) const {
  const std::vector<motion::Vec3> from(pose.begin(), pose.end());
  pose[root_] = Lerp(from[root_], next[root_], weight);
  for (const motion::Bone& bone : bones_) {
    const std::size_t parent = static_cast<std::size_t>(bone.parent);
    const std::size_t child = static_cast<std::size_t>(bone.child);
    pose[child] =
        pose[parent] + BlendBone(from[child] - from[parent], next[child] - next[parent], weight);
  }
}

void WindowState::Add(int start, const motion::Poses& window, const CrossFade& cross_fade) {
  const int first = start - begin_;
  const int shared = follower_.frame_count() - first;
  cross_fade.Blend(window, first, &follower_);
  follower_.Append(window.frames(shared, window.frame_count() - shared));
  ++window_count_;
}

void WindowState::DropFrom(int frame) {
  follower_.Resize(std::clamp(frame - begin_, 0, follower_.frame_count()));
}

void WindowState::DropBefore(int frame) {
  const int begin = std::clamp(frame, begin_, end());
  follower_.DropFront(begin - begin_);
  begin_ = begin;
}

bool ContinuesFromSettledFrames(const ModelDescription& model) {
  return model.samples && model.accepts_follower_start;
}

int WindowOverlap(const ModelDescription& model) {
  return ContinuesFromSettledFrames(model)
             ? SettledOverlap(model.window_frames) + model.lookahead_frames
             : CrossFadeOverlap(model.window_frames);
}

void ContinueFrom(const WindowState& state, int frame, const ModelDescription& model,
                  SynthesisWindow* window) {
  if (!model.accepts_follower_start) return;
  const motion::Poses& follower = state.follower();
  const int first = frame - state.begin();
  const absl::Span<const motion::Vec3> pose = follower[first];
  window->start =
      FollowerStart{follower.at(first, model.skeleton.root), {pose.begin(), pose.end()}};
  if (!ContinuesFromSettledFrames(model)) return;
  window->settled = motion::Poses(0, follower.joint_count());
  window->settled.Append(follower.frames(first, follower.frame_count() - first));
}

uint64_t WindowSeed(uint64_t seed, int window) {
  return window == 0 ? seed : base::SplitMix(seed, static_cast<uint64_t>(window));
}

uint64_t LeaderSeed(const motion::Poses& leader, double frame_rate_hz,
                    const std::vector<uint64_t>& seeds) {
  double way = 0;
  for (int t = 1; t < leader.frame_count(); ++t) {
    for (int j = 0; j < leader.joint_count(); ++j) {
      way += double{Distance(leader.at(t, j), leader.at(t - 1, j))};
    }
  }
  const double seconds = leader.frame_count() / frame_rate_hz;
  const uint64_t drawn = base::SplitMix(static_cast<uint64_t>(std::llround(way / kMetres)),
                                        static_cast<uint64_t>(std::llround(seconds / kSeconds)));
  return seeds.empty() ? drawn % kSeeds : seeds[drawn % seeds.size()];
}

motion::Standardisation WindowStandardisation(const motion::Skeleton& skeleton,
                                              const SynthesisWindow& window,
                                              motion::StandardOrigin origin) {
  if (window.partner_direction) {
    return {skeleton, window.leader, FacingYaw(*window.partner_direction), origin};
  }
  if (window.start) {
    const motion::Vec3 root = window.leader.at(0, skeleton.root);
    const motion::Vec3 toward = window.start->root - root;
    if (std::hypot(toward.x, toward.z) >= kMinDistanceMetres) {
      return {skeleton, window.leader, FacingYaw(toward), origin};
    }
  }
  return {skeleton, window.leader, motion::YawDirection::kRemove, origin};
}

NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window) {
  NetworkInput input;
  input.leader = standardisation.Apply(window.leader);
  input.hidden_frames = window.hidden_frames;
  input.labels = window.labels;
  input.sampling = window.options.sampling;
  input.settled = standardisation.Apply(window.settled);
  input.cancelled = window.cancelled.get();
  if (!window.start) return input;
  input.start = FollowerStart{standardisation.Apply(window.start->root), {}};
  for (const motion::Vec3& joint : window.start->pose) {
    input.start->pose.push_back(standardisation.Apply(joint));
  }
  return input;
}

}  // namespace duet::engine
