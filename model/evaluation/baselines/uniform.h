#ifndef DUET_MODEL_EVALUATION_BASELINES_UNIFORM_H_
#define DUET_MODEL_EVALUATION_BASELINES_UNIFORM_H_

#include <Eigen/Core>
#include <random>

namespace duet::evaluation::baselines {

// A number in [0, 1). The standard library's distributions differ from one library to the next;
// published figures must not.
inline double Uniform(std::mt19937_64* random) {
  return static_cast<double>((*random)() >> 11) * 0x1.0p-53;
}

// An index with a probability in proportion to its weight. Weights are not negative, one is
// positive.
inline Eigen::Index SampleIndex(const Eigen::Ref<const Eigen::VectorXd>& weights,
                                std::mt19937_64* random) {
  double left = Uniform(random) * weights.sum();
  Eigen::Index pick = 0;
  while (pick + 1 < weights.size() && left >= weights(pick)) left -= weights(pick++);
  return pick;
}

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_UNIFORM_H_
