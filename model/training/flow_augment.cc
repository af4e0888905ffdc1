#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/base/angle.h"
#include "model/engine/live_synthesis.h"
#include "model/motion/limb_lengths.h"
#include "model/training/flow_batches.h"

namespace duet::training {
namespace {

using base::kPi;
using motion::Poses;
using motion::Vec3;

Vec3 Horizontal(double angle) {
  return {static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))};
}

// True for the joints of the legs below the hips.
std::vector<bool> BelowHips(const motion::Skeleton& skeleton) {
  std::vector<bool> below(static_cast<size_t>(skeleton.joint_count()));
  if (!skeleton.hips) return below;
  for (const int b : BonesFromRoot(skeleton)) {
    const motion::Bone& bone = skeleton.bones[static_cast<size_t>(b)];
    below[static_cast<size_t>(bone.child)] = bone.parent == skeleton.hips->left ||
                                             bone.parent == skeleton.hips->right ||
                                             below[static_cast<size_t>(bone.parent)];
  }
  return below;
}

// One random error, applied in full or in part.
class Error {
 public:
  Error(const motion::Skeleton& skeleton, const FlowSettings::Drift& options, base::Random* random)
      : skeleton_(skeleton),
        below_hips_(BelowHips(skeleton)),
        tilt_axis_(Horizontal(random->Uniform(0, 2 * kPi))),
        bend_axis_(Horizontal(random->Uniform(0, 2 * kPi))),
        tilt_(random->Normal(options.tilt())),
        bend_(random->Normal(options.bend())),
        turn_(random->Normal(options.turn())),
        moved_{static_cast<float>(random->Normal(options.root())),
               static_cast<float>(random->Normal(options.height())),
               static_cast<float>(random->Normal(options.root()))} {
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      joints_.push_back(Normal3(options.joints(), random));
    }
  }

  // `share` 1 applies it in full. Shapes: pose [joints].
  void Apply(double share, absl::Span<Vec3> pose) const {
    if (skeleton_.hips) Bend(share, pose);
    Vec3 pivot = pose[static_cast<size_t>(skeleton_.root)];
    for (const Vec3& joint : pose) pivot.y = std::min(pivot.y, joint.y);
    const float part = static_cast<float>(share);
    for (size_t j = 0; j < pose.size(); ++j) {
      const Vec3 tilted = RotateAbout(pose[j] - pivot, tilt_axis_, share * tilt_);
      pose[j] = pivot + RotateY(tilted, share * turn_) + part * (moved_ + joints_[j]);
    }
  }

 private:
  void Bend(double share, absl::Span<Vec3> pose) const {
    const Vec3 pivot = Lerp(pose[static_cast<size_t>(skeleton_.hips->left)],
                            pose[static_cast<size_t>(skeleton_.hips->right)], 0.5f);
    for (size_t j = 0; j < pose.size(); ++j) {
      if (below_hips_[j]) continue;
      pose[j] = pivot + RotateAbout(pose[j] - pivot, bend_axis_, share * bend_);
    }
  }

  const motion::Skeleton& skeleton_;
  const std::vector<bool> below_hips_;
  const Vec3 tilt_axis_, bend_axis_;
  const double tilt_, bend_, turn_;
  const Vec3 moved_;
  std::vector<Vec3> joints_;
};

}  // namespace

void AddDrift(const motion::Skeleton& skeleton, const FlowSettings::Drift& options,
              base::Random* random, engine::NetworkInput* input, motion::Poses* target) {
  const Error error(skeleton, options, random);
  error.Apply(1, absl::MakeSpan(input->start->pose));
  input->start->root = input->start->pose[static_cast<size_t>(skeleton.root)];
  for (int t = 0; t < input->settled.frame_count(); ++t) error.Apply(1, input->settled[t]);
  const int told = std::max(1, input->settled.frame_count());
  for (int t = 0; t < target->frame_count(); ++t) {
    const double since =
        std::clamp((t - told + 1.0) / static_cast<double>(options.frames()), 0.0, 1.0);
    const double share = 0.5 + 0.5 * std::cos(kPi * since);
    if (share > 0) error.Apply(share, (*target)[t]);
  }
}

namespace {

// A random number of frames of up to `seconds`.
int DrawFrames(double seconds, double frame_rate_hz, base::Random* random) {
  const auto most = static_cast<int64_t>(std::lround(seconds * frame_rate_hz));
  return static_cast<int>(random->Below(most + 1));
}

int KnownFrames(const engine::NetworkInput& input) {
  if (!input.settled.empty()) return input.settled.frame_count();
  return input.start && !input.start->pose.empty() ? 1 : 0;
}

void Shorten(int frames, FlowExample* example) {
  const std::size_t classes =
      example->input.labels.size() / static_cast<std::size_t>(example->target.frame_count());
  example->target.Resize(frames);
  example->input.leader.Resize(frames);
  example->input.labels.resize(static_cast<std::size_t>(frames) * classes);
}

// Gives the frames after `now` the labels of `now`.
void KeepLabels(int now, int frames, std::vector<float>* labels) {
  const auto classes = static_cast<std::ptrdiff_t>(labels->size()) / frames;
  for (int t = now + 1; t < frames; ++t) {
    std::copy_n(labels->begin() + now * classes, classes, labels->begin() + t * classes);
  }
}

}  // namespace

void HideFuture(const motion::Skeleton& skeleton, double frame_rate_hz,
                const FlowSettings::Live& live, base::Random* random, FlowExample* example) {
  engine::NetworkInput& input = example->input;
  const int last_known = std::max(0, KnownFrames(input) - 1);
  const int now = last_known + DrawFrames(live.remade_seconds(), frame_rate_hz, random);
  const int newest = now + DrawFrames(live.delay_seconds(), frame_rate_hz, random);
  const int future = static_cast<int>(std::lround(live.future_seconds() * frame_rate_hz));
  const int frames = std::min(input.leader.frame_count(), now + 1 + future);
  Shorten(frames, example);
  if (now < frames) KeepLabels(now, frames, &input.labels);
  if (newest + 1 >= frames) return;
  input.hidden_frames = frames - newest - 1;
  std::vector<double> unknown;
  for (int t = newest + 1; t < frames; ++t) unknown.push_back((t - newest) / frame_rate_hz);
  input.leader.Resize(newest + 1);
  input.leader.Append(engine::ComeToRest(skeleton, input.leader, frame_rate_hz, unknown).all());
}

namespace {

// The last `frames` known frames of an example are to be answered by the network.
struct Chosen {
  FlowExample* example;
  int frames;
};

std::vector<Chosen> Choose(const FlowSettings::Own& own, base::Random* random,
                           std::vector<FlowExample>* examples) {
  std::vector<Chosen> chosen;
  for (FlowExample& example : *examples) {
    const int known = example.input.settled.frame_count();
    if (known < 2 || !random->Chance(own.share())) continue;
    const int64_t most = std::min<int64_t>(own.most_frames(), known - 1);
    chosen.push_back({&example, 1 + static_cast<int>(random->Below(most))});
  }
  return chosen;
}

// Replaces known frames [from, end) by those of `own`, and the target from there on.
void Replace(const motion::Skeleton& skeleton, const Poses& own, int from, int64_t return_frames,
             FlowExample* example) {
  Poses& known = example->input.settled;
  Poses& target = example->target;
  const std::vector<float> lengths = MedianBoneLengths(skeleton, target);
  const int last = known.frame_count() - 1;
  std::vector<Vec3> error(own[last].begin(), own[last].end());
  for (std::size_t j = 0; j < error.size(); ++j) error[j] = error[j] - target[last][j];
  for (int t = from; t <= last; ++t) {
    std::copy(own[t].begin(), own[t].end(), known[t].begin());
    std::copy(own[t].begin(), own[t].end(), target[t].begin());
  }
  const int after = target.frame_count() - last - 1;
  Poses returning(0, target.joint_count());
  returning.Append(
      target.frames(last + 1, static_cast<int>(std::min<int64_t>(after, return_frames))));
  for (int t = 0; t < returning.frame_count(); ++t) {
    const double since = (t + 1.0) / static_cast<double>(return_frames);
    const auto share = static_cast<float>(0.5 + 0.5 * std::cos(kPi * since));
    for (std::size_t j = 0; j < error.size(); ++j) returning[t][j] += error[j] * share;
  }
  SetBoneLengths(skeleton, lengths, &returning);
  std::copy(returning.all().begin(), returning.all().end(), target[last].end());
}

}  // namespace

void ContinueOwnMotion(const motion::Skeleton& skeleton, const FlowSettings::Own& own,
                       const Answer& answer, base::Random* random,
                       std::vector<FlowExample>* examples) {
  const std::vector<Chosen> chosen = Choose(own, random, examples);
  if (chosen.empty()) return;
  std::vector<engine::NetworkInput> inputs;
  for (const Chosen& one : chosen) {
    inputs.push_back(one.example->input);
    inputs.back().settled.Resize(one.example->input.settled.frame_count() - one.frames);
    inputs.back().sampling.seed = static_cast<uint64_t>(random->Below(INT64_MAX));
  }
  const std::vector<Poses> answers = answer(inputs);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Replace(skeleton, answers[i], inputs[i].settled.frame_count(), own.return_frames(),
            chosen[i].example);
  }
}

}  // namespace duet::training
