#ifndef DUET_CLIENT_BATCH_VERIFY_H_
#define DUET_CLIENT_BATCH_VERIFY_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/damage.h"

namespace duet::client::batch {

// What a look at a data set found.
struct VerifyReport {
  int64_t items = 0;    // that are done
  int64_t files = 0;    // of these
  int64_t missing = 0;  // items that were planned and are neither done, rejected nor failed
  int64_t problem_count = 0;
  std::vector<std::string> problems;  // the first hundred: a file that is gone or was changed
  Damage damage;                      // the same as the next run needs it
};

// Reads every file of a data set and compares it with the journal, and the index with that too;
// of a set without .duet-batch, such as a copy, with the index alone. Changes nothing. NOT_FOUND
// where there is neither.
absl::StatusOr<VerifyReport> Verify(const std::filesystem::path& out);

// Leaves what was found to the next run, which repairs it. ABORTED while another process is at work
// in the folder, or where it cannot be written.
absl::Status RecordDamage(const Damage& damage, const std::filesystem::path& out);

// Whether a file has a digest; NOT_FOUND, DATA_LOSS "<path>: was changed".
absl::Status CheckFile(const std::filesystem::path& path, const std::string& sha256);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_VERIFY_H_
