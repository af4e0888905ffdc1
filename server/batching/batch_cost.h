#ifndef DUET_SERVER_BATCHING_BATCH_COST_H_
#define DUET_SERVER_BATCHING_BATCH_COST_H_

#include "server/common/clock.h"

namespace duet::server::batching {

// The time that a batch takes: a fixed part for each batch, and a part for each frame of each
// window. Both are 0 if nothing is known.
struct CostEstimate {
  double batch_seconds = 0;
  double frame_seconds = 0;

  double Seconds(int frames) const { return batch_seconds + frame_seconds * frames; }
};

// Estimates a model's cost from the batches that it has evaluated, by least squares in which each
// batch weighs a fifth less than the one after it. While all batches have the same size, the cost
// is assumed to be proportional to the frames.
//
// Threads: not safe to call concurrently.
class BatchCost {
 public:
  // `frames`: total of all windows of the batch, at least 1. A time of more than four times the
  // expected one counts as four times, because a pause of the machine does not make a model slow.
  void Observe(int frames, double seconds, common::TimePoint at);

  // The estimate, halved for each second without a batch. Otherwise an estimate that is so high
  // that no window is evaluated would never be corrected.
  CostEstimate At(common::TimePoint now) const;

 private:
  CostEstimate Fit() const;

  // Weighted sums over the batches: of 1, x, y, x^2, x y, with x in frames and y in seconds.
  double weight_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
  common::TimePoint last_;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_BATCH_COST_H_
