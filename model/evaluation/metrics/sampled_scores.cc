#include "model/evaluation/metrics/sampled_scores.h"

#include <cstddef>
#include <limits>

#include "model/evaluation/metrics/displacement.h"

namespace duet::evaluation::metrics {
namespace {

size_t MotionCount(const SampledMotions& samples) {
  return samples.empty() ? 0 : samples.front().size();
}

// Between two followers of a sequence, in the world as captured, to which the raw unit refers.
double Distance(const dataset::Sequence& sequence, const motion::Poses& a, const motion::Poses& b) {
  return Afd(sequence.levelling.Invert(a), sequence.levelling.Invert(b), MetricUnit::kSbuRaw);
}

// The mean afd between any two answers to leader `i`.
double Spread(const dataset::Dataset& dataset, const SampledMotions& samples, size_t i) {
  double sum = 0, pairs = 0;
  for (size_t a = 0; a < samples.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      sum += Distance(SequenceOf(dataset, samples[a][i]), samples[a][i].follower,
                      samples[b][i].follower);
      ++pairs;
    }
  }
  return pairs == 0 ? 0 : sum / pairs;
}

}  // namespace

std::vector<ScoredMotion> Pool(const SampledMotions& samples) {
  std::vector<ScoredMotion> all;
  for (const std::vector<ScoredMotion>& set : samples) {
    all.insert(all.end(), set.begin(), set.end());
  }
  return all;
}

std::vector<ScoredMotion> MeanAnswers(const SampledMotions& samples) {
  std::vector<ScoredMotion> means;
  const float share = 1 / static_cast<float>(samples.size());
  for (size_t i = 0; i < MotionCount(samples); ++i) {
    ScoredMotion mean = samples.front()[i];
    for (size_t p = 0; p < mean.follower.all().size(); ++p) {
      motion::Vec3 sum;
      for (const std::vector<ScoredMotion>& set : samples) sum += set[i].follower.all()[p];
      mean.follower.all()[p] = share * sum;
    }
    means.push_back(std::move(mean));
  }
  return means;
}

std::vector<ScoredMotion> BestAnswers(const dataset::Dataset& dataset,
                                      const SampledMotions& samples) {
  std::vector<ScoredMotion> answers;
  for (size_t i = 0; i < MotionCount(samples); ++i) {
    const ScoredMotion* best = &samples.front()[i];
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<ScoredMotion>& set : samples) {
      const dataset::Sequence& sequence = SequenceOf(dataset, set[i]);
      const double distance = Distance(sequence, set[i].follower, sequence.pair.follower.poses);
      if (distance >= least) continue;
      best = &set[i];
      least = distance;
    }
    answers.push_back(*best);
  }
  return answers;
}

std::vector<double> MultimodalityByClass(const dataset::Dataset& dataset,
                                         const SampledMotions& samples) {
  std::vector<double> sums(dataset.classes.size()), counts(dataset.classes.size());
  for (size_t i = 0; i < MotionCount(samples); ++i) {
    const auto c = static_cast<size_t>(SequenceOf(dataset, samples.front()[i]).interaction_class);
    sums[c] += Spread(dataset, samples, i);
    ++counts[c];
  }
  for (size_t c = 0; c < sums.size(); ++c) {
    sums[c] = counts[c] == 0 ? std::numeric_limits<double>::quiet_NaN() : sums[c] / counts[c];
  }
  return sums;
}

}  // namespace duet::evaluation::metrics
