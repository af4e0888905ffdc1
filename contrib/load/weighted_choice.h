#ifndef DUET_CONTRIB_LOAD_WEIGHTED_CHOICE_H_
#define DUET_CONTRIB_LOAD_WEIGHTED_CHOICE_H_

#include <cstddef>
#include <vector>

namespace duet::contrib::load {

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

#endif  // DUET_CONTRIB_LOAD_WEIGHTED_CHOICE_H_
