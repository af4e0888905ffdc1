#ifndef DUET_SERVER_BATCHING_EVEN_SHARE_H_
#define DUET_SERVER_BATCHING_EVEN_SHARE_H_

#include <vector>

namespace duet::server::batching {

// The seconds that a batch and each window of it cost; see CostEstimate.
struct WindowCost {
  double batch_seconds = 0;
  double window_seconds = 0;
};

// How many of `windows` waiting windows, 1 or more, a free worker takes so that all workers end at
// about the same time: between 1 and all of them. While nothing is known of the cost, the free
// workers take equally many.
//
// `busy_seconds`: what is left of each batch that the other workers evaluate. `free_workers`: with
// the one that asks, 1 or more.
int EvenShare(int windows, int free_workers, std::vector<double> busy_seconds, WindowCost cost);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_EVEN_SHARE_H_
