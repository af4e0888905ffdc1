#ifndef DUET_CLIENT_BATCH_LEADER_DIGESTS_H_
#define DUET_CLIENT_BATCH_LEADER_DIGESTS_H_

#include <cstdint>
#include <mutex>
#include <string>

#include "absl/container/flat_hash_map.h"
#include "absl/status/status.h"
#include "client/batch/leader_source.h"

namespace duet::client::batch {

// The digest of each leader's file when its first answer was made, which ensures that all answers
// of a data set are made from the same leaders. Takes little more than 16 bytes for each file.
//
// Threads: safe to call concurrently.
class LeaderDigests {
 public:
  // Whether the digest of the leader's file is known.
  bool Knows(const LeaderEntry& leader) const;
  // Stores the first digest of the leader's file. FAILED_PRECONDITION, with the leader, if `sha256`
  // differs from it.
  absl::Status Check(const LeaderEntry& leader, const std::string& sha256);

 private:
  mutable std::mutex mutex_;
  absl::flat_hash_map<uint64_t, uint64_t> digests_;  // by hash of the path; the first 64 bits
};

// The current digests of leaders' files, each of which is read once. Takes 16 to 32 bytes for each
// file.
class ReadDigests {
 public:
  // The first 16 hex digits; empty if the file cannot be read.
  std::string Of(const LeaderEntry& leader);

 private:
  absl::flat_hash_map<uint64_t, uint64_t> digests_;  // by hash of the path; the first 64 bits
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_DIGESTS_H_
