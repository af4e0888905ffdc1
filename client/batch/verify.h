#ifndef DUET_CLIENT_BATCH_VERIFY_H_
#define DUET_CLIENT_BATCH_VERIFY_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/damage.h"

namespace duet::client::batch {

// The result of verifying a data set.
struct VerifyReport {
  int64_t items = 0;  // done items
  int64_t files = 0;  // of done items
  int64_t problem_count = 0;
  // Planned items that are neither done, rejected nor failed. Absent: unknown, because only
  // summary.json has the plan, and no run has written it yet, or it cannot be read.
  std::optional<int64_t> missing;
  std::vector<std::string> problems;  // the first hundred: files that are missing or were changed
  Damage damage;                      // the same for the next run
};

// Compares every file of a data set and its index with the journal. A set without .duet-batch, such
// as a copy, is only compared with its index. Changes nothing. NOT_FOUND if there is neither.
absl::StatusOr<VerifyReport> Verify(const std::filesystem::path& out);

// Records the damage for the next run, which repairs it. ABORTED if another process works in the
// folder, or if the folder cannot be written.
absl::Status RecordDamage(const Damage& damage, const std::filesystem::path& out);

// Checks that a file has a digest. NOT_FOUND; DATA_LOSS "<path>: was changed".
absl::Status CheckFile(const std::filesystem::path& path, const std::string& sha256);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_VERIFY_H_
