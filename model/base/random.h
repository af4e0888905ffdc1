#ifndef DUET_MODEL_BASE_RANDOM_H_
#define DUET_MODEL_BASE_RANDOM_H_

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace duet::base {

// Random numbers that are the same with every compiler and standard library: published results hang
// on them. The bits are std::mt19937_64's, which the standard fixes; the distributions are our own,
// since the standard library's differ. Changing what a function draws, or how many bits it takes,
// changes the results of every experiment.
class Random {
 public:
  explicit Random(uint64_t seed) : bits_(seed) {}
  // A stream of its own for each part of a run, such as an epoch: depends on these two numbers
  // alone, so that a resumed run draws what an uninterrupted one would.
  Random(uint64_t seed, int64_t part);

  // In [0, 1), a multiple of 2^-53.
  double Uniform();
  // In [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  // An integer in [0, end). `end` is 1 or more; far below 2^64, all are equally likely.
  int64_t Below(int64_t end);
  bool Chance(double probability) { return Uniform() < probability; }

  // A normal number of mean 0. Source: Box, Muller 1958.
  double Normal(double deviation);
  // The same with a deviation of 1, from other uniform numbers: the middles of the 2^53 steps of
  // (0, 1). Not Normal(1) in the last digits; the published t-SNE maps start from these.
  double StandardNormal();

  // In (0, 1): the middle of a step of 2^-53. StandardNormal takes two: radius, then angle.
  double OpenUniform();

  // Puts the values in a random order. Source: Fisher, Yates; Durstenfeld 1964.
  template <typename T>
  void Shuffle(std::vector<T>* values) {
    for (std::size_t i = values->size(); i > 1; --i) {
      std::swap((*values)[i - 1],
                (*values)[static_cast<std::size_t>(Below(static_cast<int64_t>(i)))]);
    }
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_RANDOM_H_
