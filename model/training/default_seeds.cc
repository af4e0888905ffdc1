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

// Seeds that are tried, and how many of them are kept: enough that callers see different people,
// and few enough that all are good. The cost is kTried answers to kPairsOfClass leaders of each
// class: some ten seconds for the data of the embedded models.
constexpr uint64_t kTried = 128;
constexpr std::size_t kChosen = 16;
constexpr int kPairsOfClass = 8;
// Shorter distances count as this one: followers who stand still have no logarithm. Metres.
constexpr double kLeastMetres = 0.01;

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

// What followers of one class do, sums over its pairs: how far they get, and how near their leaders
// they come, metres.
struct Behaviour {
  double reach = 0, nearest = 0;

  void Add(int root, const Poses& leader, const Poses& follower) {
    reach += ReachOf(follower);
    float least = Distance(leader.at(0, root), follower.at(0, root));
    for (int t = 1; t < follower.frame_count(); ++t) {
      least = std::min(least, Distance(leader.at(t, root), follower.at(t, root)));
    }
    nearest += double{least};
  }
};

// Captured pairs of one class: the leaders' windows, and what the followers do.
struct ClassPairs {
  std::vector<engine::SynthesisWindow> windows;
  Behaviour captured;
};

double SquaredLogRatio(double a, double b) {
  const double times = std::log(std::max(kLeastMetres, a) / std::max(kLeastMetres, b));
  return times * times;
}

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
    pairs.captured.Add(dataset.skeleton.root, sequence.pair.leader.poses,
                       sequence.pair.follower.poses);
  }
  return classes;
}

// How unlike captured followers those of a seed are: the squared logarithms of how much farther
// they get, and of how much farther they stay away, sum over the classes.
absl::StatusOr<double> Unlikeness(const engine::Synthesizer& synthesizer, int root,
                                  std::vector<ClassPairs>* classes, uint64_t seed) {
  double unlikeness = 0;
  for (ClassPairs& pairs : *classes) {
    for (engine::SynthesisWindow& window : pairs.windows) window.options.sampling.seed = seed;
    Behaviour answers;
    const std::vector<engine::WindowResult> followers = AnswerAll(synthesizer, pairs.windows);
    for (std::size_t i = 0; i < followers.size(); ++i) {
      if (!followers[i].ok()) return followers[i].status();
      answers.Add(root, pairs.windows[i].leader, *followers[i]);
    }
    unlikeness += SquaredLogRatio(answers.reach, pairs.captured.reach) +
                  SquaredLogRatio(answers.nearest, pairs.captured.nearest);
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
    const absl::StatusOr<double> one =
        Unlikeness(synthesizer, dataset.skeleton.root, &classes, seed);
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
