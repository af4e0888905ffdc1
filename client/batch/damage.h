#ifndef DUET_CLIENT_BATCH_DAMAGE_H_
#define DUET_CLIENT_BATCH_DAMAGE_H_

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace duet::client::batch {

// What of a data set is to be made again: written by whoever finds it (verify, packing), removed by
// the run that has repaired it. A run that is stopped in between repairs it all again.
struct Damage {
  std::set<int64_t> items;       // whose files are not what their records say
  std::set<std::string> shards;  // that are not as they were written, whatever their items
  bool empty() const { return items.empty() && shards.empty(); }
};

// What `file` says (JobFolder::damage). Nothing where it is not there or cannot be read: what is
// damaged can be found again.
Damage ReadDamage(const std::filesystem::path& file);

// Replaces `file`, removes it where there is no damage. ABORTED as of durable_file.h.
absl::Status WriteDamage(const Damage& damage, const std::filesystem::path& file);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DAMAGE_H_
