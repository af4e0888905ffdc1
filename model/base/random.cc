#include "model/base/random.h"

#include <cmath>

namespace duet::base {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSpareBits = 64 - 53;  // a double has 53 significant ones
constexpr double kStep = 0x1.0p-53;

}  // namespace

Random::Random(uint64_t seed, int64_t part) {
  std::seed_seq sequence{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32),
                         static_cast<uint32_t>(part), static_cast<uint32_t>(part >> 32)};
  bits_.seed(sequence);
}

double Random::Uniform() { return static_cast<double>(bits_() >> kSpareBits) * kStep; }

double Random::OpenUniform() { return (static_cast<double>(bits_() >> kSpareBits) + 0.5) * kStep; }

int64_t Random::Below(int64_t end) {
  return static_cast<int64_t>(bits_() % static_cast<uint64_t>(end));
}

double Random::Normal(double deviation) {
  const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
  return deviation * radius * std::cos(2 * kPi * Uniform());
}

double Random::StandardNormal() {
  const double radius = std::sqrt(-2 * std::log(OpenUniform()));
  return radius * std::cos(2 * kPi * OpenUniform());
}

}  // namespace duet::base
