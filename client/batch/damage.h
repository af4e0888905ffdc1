#ifndef DUET_CLIENT_BATCH_DAMAGE_H_
#define DUET_CLIENT_BATCH_DAMAGE_H_

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace duet::client::batch {

// The parts of a data set that the next run must make again. Verify and packing write it; the run
// that has repaired everything removes it. After an interrupted run, the next run repairs
// everything again.
struct Damage {
  std::set<int64_t> items;       // whose files do not match their records
  std::set<std::string> shards;  // that do not have the bytes that were written
  bool empty() const { return items.empty() && shards.empty(); }
};

// Reads `file` (JobFolder::damage). Empty if the file is missing or cannot be read: verify finds
// the damage again.
Damage ReadDamage(const std::filesystem::path& file);

// Replaces `file`, or removes it if there is no damage. ABORTED as in durable_file.h.
absl::Status WriteDamage(const Damage& damage, const std::filesystem::path& file);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DAMAGE_H_
