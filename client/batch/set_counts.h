#ifndef DUET_CLIENT_BATCH_SET_COUNTS_H_
#define DUET_CLIENT_BATCH_SET_COUNTS_H_

#include <cstdint>
#include <vector>

#include "client/batch/failures.h"

namespace duet::client::batch {

// The number of items in a data set by result.
struct SetCounts {
  int64_t done = 0;
  int64_t rejected = 0;
  int64_t failed = 0;
  int64_t failed_leaders = 0;  // different files of items that failed
  uint64_t bytes = 0;
  std::vector<FailureCause> failures;  // the causes of most items
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SET_COUNTS_H_
