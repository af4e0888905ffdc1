#ifndef DUET_SERVER_BATCHING_BATCH_COST_H_
#define DUET_SERVER_BATCHING_BATCH_COST_H_

#include "server/common/clock.h"

namespace duet::server::batching {

// How long a batch takes: a part that every batch pays once, and a part for each frame of each
// window. Both 0 where nothing is known.
struct CostEstimate {
  double batch_seconds = 0;
  double frame_seconds = 0;

  double Seconds(int frames) const { return batch_seconds + frame_seconds * frames; }
};

// Learns a model's cost from the batches that it has evaluated: least squares in which each batch
// weighs a fifth less than the one after it. As long as all batches are of one size, cost is taken
// to be proportional to frames.
//
// Threads: not safe to call concurrently.
class BatchCost {
 public:
  // `frames`: of all windows of the batch together, 1 or more. What took more than four times as
  // long as expected counts as four times: a machine that paused for a moment is not a slow model.
  void Observe(int frames, double seconds, common::TimePoint at);

  // What is known, halved for each second without a batch: an estimate that keeps windows from
  // being evaluated must not stand for ever, as nothing would correct it.
  CostEstimate At(common::TimePoint now) const;

 private:
  CostEstimate Fit() const;

  // Weighted sums over the batches: of 1, x, y, x^2, x y, with x in frames and y in seconds.
  double weight_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
  common::TimePoint last_;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_BATCH_COST_H_
