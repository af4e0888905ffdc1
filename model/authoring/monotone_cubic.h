#ifndef DUET_MODEL_AUTHORING_MONOTONE_CUBIC_H_
#define DUET_MODEL_AUTHORING_MONOTONE_CUBIC_H_

#include <vector>

namespace duet::authoring {

// Interpolates a value over time through keys. It starts and ends at rest, has a continuous
// velocity, and never leaves the range of the two neighbouring keys (a planted foot stays planted,
// a reach does not overshoot). It is constant before the first key and after the last.
//
// Source: Fritsch and Carlson 1980, with the harmonic mean of the neighbouring slopes.
class MonotoneCubic {
 public:
  struct Key {
    double time = 0;
    double value = 0;
  };
  // Requires at least one key, with strictly increasing times.
  explicit MonotoneCubic(std::vector<Key> keys);
  double At(double time) const;

 private:
  std::vector<Key> keys_;
  std::vector<double> slopes_;  // [keys]
};

}  // namespace duet::authoring

#endif  // DUET_MODEL_AUTHORING_MONOTONE_CUBIC_H_
