#ifndef DUET_CLIENT_BATCH_FAILURES_H_
#define DUET_CLIENT_BATCH_FAILURES_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/job_folder.h"

namespace duet::client::batch {

// How many leaders of a run may have items that fail permanently, without the run counting as
// failed: a number, or a share of its leaders.
struct AllowedFailures {
  int64_t leaders = 0;
  std::optional<double> share;  // 0 to 1, instead of the number

  bool Allows(int64_t failed_leaders, int64_t all_leaders) const;
};

// "5" or "2%". INVALID_ARGUMENT 'expected ..., got "text"'.
inline constexpr char kAllowedFailuresForm[] = "COUNT|PERCENT%";
absl::StatusOr<AllowedFailures> ParseAllowedFailures(absl::string_view text);

// Why items failed, without file names, so that many leaders can have the same cause.
struct FailureCause {
  std::string code;     // of a gRPC status, such as "INVALID_ARGUMENT"
  std::string message;  // such as "no such file"
  int64_t items = 0;
  int64_t leaders = 0;
};

// [{"code", "message", "items", "leaders"}]
nlohmann::ordered_json ToJson(const std::vector<FailureCause>& causes);

// Counts failures by cause. After a thousand different causes, all others are counted as one.
class FailureCauses {
 public:
  // `leader`: as listed. If `message` begins with its file, the file is left out.
  void Add(absl::string_view leader, absl::string_view code, absl::string_view message,
           int64_t items, int64_t leaders);
  // At most `count` causes, those of the most items first.
  std::vector<FailureCause> Largest(size_t count) const;

 private:
  std::map<std::pair<std::string, std::string>, std::pair<int64_t, int64_t>> counts_;
};

// Writes failed.tsv: one row for each leader and cause, with the names of the failed items. Records
// come leader by leader.
class FailureTable {
 public:
  explicit FailureTable(const JobFolder& folder)
      : file_(folder.temporary() / "failed.tsv"), path_(folder.out() / "failed.tsv") {}
  absl::Status Open();
  // `record`: of an item that failed.
  absl::Status Add(const nlohmann::ordered_json& record);
  absl::Status Finish();
  const FailureCauses& causes() const { return causes_; }
  // Different leaders, as listed.
  int64_t leaders() const { return static_cast<int64_t>(leaders_.size()); }

 private:
  absl::Status WriteLeader();

  DurableFile file_;
  const std::filesystem::path path_;
  FailureCauses causes_;
  // For the current leader: code and message to the items' names.
  std::string leader_;
  absl::flat_hash_set<std::string> leaders_;
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> names_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_FAILURES_H_
