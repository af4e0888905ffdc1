#include "model/engine/window_seed.h"

#include <cmath>

#include "model/base/split_mix.h"

namespace duet::engine {
namespace {

// Lengths of clips and ways of joints that differ by less are mostly the same leader.
constexpr double kSeconds = 0.25;
constexpr double kMetres = 0.05;
constexpr uint64_t kSeeds = uint64_t{1} << 32;  // every number of JSON can hold them

}  // namespace

uint64_t WindowSeed(uint64_t seed, int window) {
  return window == 0 ? seed : base::SplitMix(seed, static_cast<uint64_t>(window));
}

uint64_t LeaderSeed(const motion::Poses& leader, double frame_rate_hz,
                    const std::vector<uint64_t>& seeds) {
  double way = 0;
  for (int t = 1; t < leader.frame_count(); ++t) {
    for (int j = 0; j < leader.joint_count(); ++j) {
      way += double{Distance(leader.at(t, j), leader.at(t - 1, j))};
    }
  }
  const double seconds = leader.frame_count() / frame_rate_hz;
  const uint64_t drawn = base::SplitMix(static_cast<uint64_t>(std::llround(way / kMetres)),
                                        static_cast<uint64_t>(std::llround(seconds / kSeconds)));
  return seeds.empty() ? drawn % kSeeds : seeds[drawn % seeds.size()];
}

}  // namespace duet::engine
