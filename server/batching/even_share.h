#ifndef DUET_SERVER_BATCHING_EVEN_SHARE_H_
#define DUET_SERVER_BATCHING_EVEN_SHARE_H_

#include <vector>

namespace duet::server::batching {

// Cost of a batch and of each of its windows, in seconds; see CostEstimate.
struct WindowCost {
  double batch_seconds = 0;
  double window_seconds = 0;
};

// Returns how many of `windows` waiting windows (at least 1) a free worker takes so that all
// workers finish at about the same time: between 1 and `windows`. While the cost is unknown, the
// free workers take equal numbers.
//
// `busy_seconds`: remaining time of each batch that other workers evaluate. `free_workers`:
// including the one that asks, at least 1.
int EvenShare(int windows, int free_workers, std::vector<double> busy_seconds, WindowCost cost);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_EVEN_SHARE_H_
