#ifndef DUET_MODEL_BASE_RANDOM_H_
#define DUET_MODEL_BASE_RANDOM_H_

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace duet::base {

// Random numbers that are the same with every compiler and standard library, because published
// results depend on them. The bits come from std::mt19937_64, which the standard specifies. The
// distributions are defined here, because those of standard libraries differ. To change what a
// function draws, or how many bits it takes, changes the results of every experiment.
class Random {
 public:
  explicit Random(uint64_t seed) : bits_(seed) {}
  // An independent stream for each part of a run, such as an epoch. It depends only on these two
  // numbers, so that a resumed run draws the same numbers as an uninterrupted one.
  Random(uint64_t seed, int64_t part);

  // In [0, 1), a multiple of 2^-53.
  double Uniform();
  // In [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  // An integer in [0, end). Requires end >= 1. Uniform if `end` is far below 2^64.
  int64_t Below(int64_t end);
  bool Chance(double probability) { return Uniform() < probability; }

  // Normally distributed with mean 0. Source: Box, Muller 1958.
  double Normal(double deviation);
  // Normally distributed with mean 0 and deviation 1, from OpenUniform. Differs from Normal(1) in
  // the last digits. The published t-SNE maps start from these numbers.
  double StandardNormal();

  // In (0, 1): the middle of one of 2^53 equal steps. StandardNormal draws two: radius, then angle.
  double OpenUniform();

  // Shuffles the values. Source: Fisher, Yates; Durstenfeld 1964.
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

// Writes the first `count` numbers that Random(seed, part).OpenUniform() returns, in less than half
// of the time: std::mt19937_64 makes its numbers one by one, this makes 312 at once.
void FillOpenUniform(uint64_t seed, int64_t part, std::ptrdiff_t count, double* out);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_RANDOM_H_
