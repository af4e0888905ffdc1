#include "server/batching/even_share.h"

#include <algorithm>
#include <cmath>

namespace duet::server::batching {
namespace {

// Returns the seconds until all frames are done if the free workers, and the workers that become
// free early enough, share them. `busy_seconds` is ascending.
double EndOfAll(int frames, int free_workers, const std::vector<double>& busy_seconds,
                const CostEstimate& cost) {
  int workers = free_workers;
  double work = frames * cost.frame_seconds + workers * cost.batch_seconds;
  for (const double busy : busy_seconds) {
    if (busy + cost.batch_seconds >= work / workers) break;
    work += busy + cost.batch_seconds;
    ++workers;
  }
  return work / workers;
}

}  // namespace

int EvenShare(int frames, int free_workers, std::vector<double> busy_seconds,
              const CostEstimate& cost) {
  double share = static_cast<double>(frames) / free_workers;
  if (cost.frame_seconds > 0) {
    std::sort(busy_seconds.begin(), busy_seconds.end());
    const double end = EndOfAll(frames, free_workers, busy_seconds, cost);
    share = (end - cost.batch_seconds) / cost.frame_seconds;
  }
  // Slightly less, so that rounding errors do not add a frame.
  return std::clamp(static_cast<int>(std::ceil(share - 1e-6)), 1, frames);
}

}  // namespace duet::server::batching
