#include "model/base/random.h"

#include <cmath>

#include "model/base/angle.h"
#include "model/base/seed_sequence.h"

namespace duet::base {
namespace {

constexpr int kSpareBits = 64 - 53;  // a double has 53 significant bits
constexpr double kStep = 0x1.0p-53;

}  // namespace

Random::Random(uint64_t seed, int64_t part) {
  const SeedSequence sequence = SeedsOfPart(seed, part);
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
