#include "client/batch/shard.h"

#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

// The variables in which a cluster passes the index and the count of a task.
struct Convention {
  const char* index;
  const char* count;
  const char* first;  // the number of the first task; null: 0
};

constexpr Convention kConventions[] = {
    {"JOB_COMPLETION_INDEX", "JOB_COMPLETIONS", nullptr},
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "AWS_BATCH_JOB_ARRAY_SIZE", nullptr},
};

uint32_t HexNumber(absl::string_view digits) {
  uint32_t number = 0;
  for (const char c : digits) {
    number = number * 16 + static_cast<uint32_t>(c <= '9' ? c - '0' : c - 'a' + 10);
  }
  return number;
}

absl::StatusOr<int> ReadNumber(const ReadVariable& read, const char* name) {
  const std::optional<std::string> text = read(name);
  int value = 0;
  if (text.has_value() && absl::SimpleAtoi(*text, &value)) return value;
  return absl::InvalidArgumentError(absl::StrCat(name, ": expected a number, got ",
                                                 text.has_value() ? base::Quoted(*text) : "none",
                                                 ". Set it, or use --shard INDEX/COUNT"));
}

absl::StatusOr<Shard> ReadConvention(const Convention& convention, const ReadVariable& read) {
  const absl::StatusOr<int> index = ReadNumber(read, convention.index);
  const absl::StatusOr<int> count = ReadNumber(read, convention.count);
  if (!index.ok()) return index.status();
  if (!count.ok()) return count.status();
  int first = 0;
  if (convention.first != nullptr && read(convention.first).has_value()) {
    const absl::StatusOr<int> number = ReadNumber(read, convention.first);
    if (!number.ok()) return number.status();
    first = *number;
  }
  const Shard shard{*index - first, *count};
  if (shard.index >= 0 && shard.index < shard.count) return shard;
  return absl::InvalidArgumentError(absl::StrCat(convention.index, ": expected one of ",
                                                 shard.count, " indices from ", first, ", got ",
                                                 *index));
}

}  // namespace

bool Shard::Has(absl::string_view item_id) const {
  // The id is a digest, so its hex digits are uniformly distributed.
  return static_cast<int>(HexNumber(item_id.substr(0, 8)) % static_cast<uint32_t>(count)) == index;
}

bool InShare(absl::string_view item_id, double share) {
  return share >= 1 || HexNumber(item_id.substr(8, 8)) < share * 4294967296.0;
}

absl::StatusOr<Shard> ParseShard(absl::string_view text) {
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits('/', 1));
  Shard shard;
  if (absl::SimpleAtoi(parts.first, &shard.index) && absl::SimpleAtoi(parts.second, &shard.count) &&
      shard.index >= 0 && shard.index < shard.count) {
    return shard;
  }
  return absl::InvalidArgumentError(
      absl::StrCat("expected INDEX/COUNT such as 0/8, with an index from 0 to COUNT - 1, got ",
                   base::Quoted(text)));
}

absl::StatusOr<Shard> ShardFromEnvironment(const ReadVariable& read) {
  for (const Convention& convention : kConventions) {
    // Kubernetes always sets the index of an indexed job. The user sets the count.
    if (read(convention.index).has_value()) return ReadConvention(convention, read);
  }
  return Shard{};
}

}  // namespace duet::client::batch
