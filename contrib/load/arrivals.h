#ifndef DUET_CONTRIB_LOAD_ARRIVALS_H_
#define DUET_CONTRIB_LOAD_ARRIVALS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contrib/load/time.h"
#include "model/base/random.h"

namespace duet::contrib::load {

enum class ArrivalKind {
  kPoisson,   // independent callers: gaps from an exponential distribution
  kConstant,  // one gap for all
};

// The due times of calls in an open loop, independent of the answers.
class Arrivals {
 public:
  // `rate_hz`: calls a second on average, above 0. The same seed gives the same times.
  Arrivals(ArrivalKind kind, double rate_hz, uint64_t seed);

  // The due time of the next call, from the start. The first call of kConstant is due at once.
  Duration Next();

 private:
  const ArrivalKind kind_;
  const double rate_hz_;
  base::Random random_;
  int64_t calls_ = 0;
  double seconds_ = 0;
};

// Picks an index by weight.
class WeightedChoice {
 public:
  // At least one weight, each above 0.
  explicit WeightedChoice(const std::vector<double>& weights) {
    double sum = 0;
    for (const double weight : weights) ends_.push_back(sum += weight);
  }

  // The index for `uniform` in [0, 1).
  std::size_t Pick(double uniform) const {
    std::size_t index = 0;
    while (index + 1 < ends_.size() && uniform * ends_.back() >= ends_[index]) ++index;
    return index;
  }

 private:
  std::vector<double> ends_;  // cumulative shares
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_ARRIVALS_H_
