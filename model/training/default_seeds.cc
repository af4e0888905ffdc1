#include "model/training/default_seeds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "model/base/random.h"
#include "model/motion/poses.h"
#include "model/training/example.h"
#include "model/training/frame_labels.h"
#include "model/training/sampler.h"
#include "model/training/trained_synthesizer.h"

namespace duet::training {
namespace {

using motion::Poses;

constexpr uint64_t kTried = 128;
constexpr std::size_t kChosen = 16;
// Captured pairs that each class is judged by. With four, the chosen seeds change with the pairs.
constexpr int kPairsOfClass = 8;
constexpr double kLeastReach = 0.01;  // metres

// How far a follower gets: the largest distance of a joint from where it was in the first frame,
// mean over the joints.
double ReachOf(const Poses& follower) {
  double sum = 0;
  for (int j = 0; j < follower.joint_count(); ++j) {
    float most = 0;
    for (int t = 1; t < follower.frame_count(); ++t) {
      most = std::max(most, Distance(follower.at(t, j), follower.at(0, j)));
    }
    sum += double{most};
  }
  return sum / follower.joint_count();
}

// Captured pairs of one class: the leaders' windows, and how far the followers get.
struct ClassPairs {
  std::vector<engine::SynthesisWindow> windows;
  double reach = 0;  // sum over the pairs
};

std::vector<ClassPairs> DrawPairs(const dataset::Dataset& dataset, std::vector<int> train) {
  base::Random random(0);
  random.Shuffle(&train);
  std::vector<ClassPairs> classes(static_cast<std::size_t>(dataset.class_count()));
  for (const int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(index)];
    ClassPairs& pairs = classes[static_cast<std::size_t>(sequence.interaction_class)];
    if (pairs.windows.size() == kPairsOfClass) continue;
    engine::SynthesisWindow window =
        MakeWindow(dataset, CapturedExample(dataset, sequence, StartKnowledge::kNone));
    window.labels = DrawFrameLabels(sequence, dataset.class_count(), {}, &random);
    pairs.windows.push_back(std::move(window));
    pairs.reach += ReachOf(sequence.pair.follower.poses);
  }
  return classes;
}

// How unlike captured followers those of a seed are: the square of the logarithm of how much
// farther they get, sum over the classes.
absl::StatusOr<double> Unlikeness(const engine::Synthesizer& synthesizer,
                                  std::vector<ClassPairs>* classes, uint64_t seed) {
  double unlikeness = 0;
  for (ClassPairs& pairs : *classes) {
    for (engine::SynthesisWindow& window : pairs.windows) window.options.sampling.seed = seed;
    double reach = 0;
    for (const engine::WindowResult& follower : AnswerAll(synthesizer, pairs.windows)) {
      if (!follower.ok()) return follower.status();
      reach += ReachOf(*follower);
    }
    const double times =
        std::log(std::max(kLeastReach, reach) / std::max(kLeastReach, pairs.reach));
    unlikeness += times * times;
  }
  return unlikeness;
}

}  // namespace

absl::StatusOr<std::vector<uint64_t>> ChooseDefaultSeeds(const engine::Synthesizer& synthesizer,
                                                         const dataset::Dataset& dataset,
                                                         const std::vector<int>& train) {
  std::vector<ClassPairs> classes = DrawPairs(dataset, train);
  std::vector<double> unlikeness;
  for (uint64_t seed = 0; seed < kTried; ++seed) {
    const absl::StatusOr<double> one = Unlikeness(synthesizer, &classes, seed);
    if (!one.ok()) return one.status();
    unlikeness.push_back(*one);
  }
  std::vector<uint64_t> seeds(kTried);
  std::iota(seeds.begin(), seeds.end(), uint64_t{0});
  std::stable_sort(seeds.begin(), seeds.end(), [&](uint64_t a, uint64_t b) {
    return unlikeness[static_cast<std::size_t>(a)] < unlikeness[static_cast<std::size_t>(b)];
  });
  seeds.resize(kChosen);
  return seeds;
}

}  // namespace duet::training
