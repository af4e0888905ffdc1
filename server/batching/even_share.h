#ifndef DUET_SERVER_BATCHING_EVEN_SHARE_H_
#define DUET_SERVER_BATCHING_EVEN_SHARE_H_

#include <vector>

#include "server/batching/batch_cost.h"

namespace duet::server::batching {

// Returns how many of `frames` waiting frames (at least 1) a free worker takes so that all workers
// finish at about the same time: between 1 and `frames`. While the cost is unknown, the free
// workers take equal numbers.
//
// `busy_seconds`: remaining time of each batch that other workers evaluate. `free_workers`:
// including the one that asks, at least 1.
int EvenShare(int frames, int free_workers, std::vector<double> busy_seconds,
              const CostEstimate& cost);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_EVEN_SHARE_H_
