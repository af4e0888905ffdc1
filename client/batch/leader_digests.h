#ifndef DUET_CLIENT_BATCH_LEADER_DIGESTS_H_
#define DUET_CLIENT_BATCH_LEADER_DIGESTS_H_

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "absl/container/flat_hash_map.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/leader_entry.h"

namespace duet::client::batch {

// What each leader's file was when its first answer was made: all answers of a data set are of the
// same leaders. 16 bytes and a little more for each file.
//
// Threads: safe to call concurrently.
class LeaderDigests {
 public:
  // Whether the leader's file has a digest by now.
  bool Knows(const LeaderEntry& leader) const;
  // Keeps the first digest of the leader's file. FAILED_PRECONDITION, naming the leader, where
  // `sha256` is another.
  absl::Status Check(const LeaderEntry& leader, const std::string& sha256);
  // The same of an item's record, whose leader is known as it was listed.
  absl::Status CheckRecord(const nlohmann::ordered_json& record);

 private:
  mutable std::mutex mutex_;
  absl::flat_hash_map<uint64_t, uint64_t> digests_;  // by hash of the path; the first 64 bits
};

// The digest of the leader's file as it is. Errors as of base::ReadFile.
absl::StatusOr<std::string> DigestOfLeader(const LeaderEntry& leader);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_DIGESTS_H_
