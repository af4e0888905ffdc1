#ifndef DUET_CLIENT_BATCH_ITEM_LIMIT_H_
#define DUET_CLIENT_BATCH_ITEM_LIMIT_H_

#include <cstdint>

namespace duet::client::batch {

// Maximum number of items of a plan, and the upper bound of item numbers in a journal. A journal of
// this size takes half a GiB of memory.
inline constexpr int64_t kMaxItems = int64_t{1} << 26;

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ITEM_LIMIT_H_
