#ifndef DUET_CLIENT_BATCH_ITEM_LIMIT_H_
#define DUET_CLIENT_BATCH_ITEM_LIMIT_H_

#include <cstdint>

namespace duet::client::batch {

// The most items that a plan may have, and so one more than the largest number in a journal: half a
// GiB of a journal in memory.
inline constexpr int64_t kMaxItems = int64_t{1} << 26;

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ITEM_LIMIT_H_
