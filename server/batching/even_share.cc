#include "server/batching/even_share.h"

#include <algorithm>
#include <cmath>

namespace duet::server::batching {
namespace {

// Returns the seconds until all windows are done if the free workers, and the workers that become
// free early enough, share them. `busy_seconds` is ascending.
double EndOfAll(int windows, int free_workers, const std::vector<double>& busy_seconds,
                WindowCost cost) {
  int workers = free_workers;
  double work = windows * cost.window_seconds + workers * cost.batch_seconds;
  for (const double busy : busy_seconds) {
    if (busy + cost.batch_seconds >= work / workers) break;
    work += busy + cost.batch_seconds;
    ++workers;
  }
  return work / workers;
}

}  // namespace

int EvenShare(int windows, int free_workers, std::vector<double> busy_seconds, WindowCost cost) {
  double share = static_cast<double>(windows) / free_workers;
  if (cost.window_seconds > 0) {
    std::sort(busy_seconds.begin(), busy_seconds.end());
    const double end = EndOfAll(windows, free_workers, busy_seconds, cost);
    share = (end - cost.batch_seconds) / cost.window_seconds;
  }
  // Slightly less, so that rounding errors do not add a window.
  return std::clamp(static_cast<int>(std::ceil(share - 1e-6)), 1, windows);
}

}  // namespace duet::server::batching
