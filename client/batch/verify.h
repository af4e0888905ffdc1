#ifndef DUET_CLIENT_BATCH_VERIFY_H_
#define DUET_CLIENT_BATCH_VERIFY_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace duet::client::batch {

// What a look at a data set found.
struct VerifyReport {
  int64_t items = 0;    // in the index
  int64_t files = 0;    // as the index says
  int64_t missing = 0;  // items that were planned and are neither done, rejected nor failed
  int64_t problem_count = 0;
  std::vector<std::string> problems;  // the first hundred: a file that is gone or was changed
};

// Reads every file of a data set and compares it with index.jsonl. NOT_FOUND where there is none,
// DATA_LOSS where the index cannot be read.
absl::StatusOr<VerifyReport> Verify(const std::filesystem::path& out);

// Whether a file has a digest; NOT_FOUND, DATA_LOSS "<path>: was changed".
absl::Status CheckFile(const std::filesystem::path& path, const std::string& sha256);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_VERIFY_H_
