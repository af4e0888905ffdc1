#include "tests/evaluation/support/sweep_curve.h"

namespace duet::test {

evaluation::experiments::SweepCurve MakeSweepCurve(
    int own, int raised, const std::function<double(double)>& probability) {
  evaluation::experiments::SweepCurve curve{own, raised, {}};
  for (const double weight : evaluation::experiments::SweepWeights()) {
    const float p = static_cast<float>(probability(weight));
    std::vector<float> both(2, 1 - p);
    both[static_cast<size_t>(raised)] = p;
    curve.probabilities.push_back(both);
  }
  return curve;
}

}  // namespace duet::test
