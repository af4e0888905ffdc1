#include "model/training/own_history.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/motion/limb_lengths.h"

namespace duet::training {
namespace {

using motion::Poses;

// The last `frames` known frames of an example are to be answered by the network.
struct Chosen {
  FlowExample* example;
  int frames;
};

std::vector<Chosen> Choose(const FlowTraining::Own& own, base::Random* random,
                           std::vector<FlowExample>* examples) {
  std::vector<Chosen> chosen;
  for (FlowExample& example : *examples) {
    const int known = example.input.settled.frame_count();
    if (known < 2 || !random->Chance(own.share)) continue;
    const int64_t most = std::min<int64_t>(own.most_frames, known - 1);
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
  std::vector<motion::Vec3> error(own[last].begin(), own[last].end());
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
    const auto share = static_cast<float>(0.5 + 0.5 * std::cos(base::kPi * since));
    for (std::size_t j = 0; j < error.size(); ++j) returning[t][j] += error[j] * share;
  }
  SetBoneLengths(skeleton, lengths, &returning);
  std::copy(returning.all().begin(), returning.all().end(), target[last].end());
}

}  // namespace

void ContinueOwnMotion(const motion::Skeleton& skeleton, const FlowTraining::Own& own,
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
    Replace(skeleton, answers[i], inputs[i].settled.frame_count(), own.return_frames,
            chosen[i].example);
  }
}

}  // namespace duet::training
