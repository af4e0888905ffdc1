#ifndef DUET_CLIENT_BATCH_ORIGINS_H_
#define DUET_CLIENT_BATCH_ORIGINS_H_

#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "absl/container/flat_hash_map.h"
#include "absl/status/status.h"
#include "client/batch/leaders.h"
#include "client/result.h"

namespace duet::client::batch {

// What all answers of a data set are made from: the content of each leader's file, and one kind of
// server for each model.

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

// What decides the bits of an answer besides its request and the weights.
struct MadeBy {
  bool cleaned_up = false;
  std::string engine;
  std::string server_version;
};

MadeBy MadeByOf(const SynthesisResult& result);
// Absent for items without an answer.
std::optional<MadeBy> MadeByOf(const v1::IndexEntry& record);
void AddMadeBy(const MadeBy& made_by, nlohmann::ordered_json* record);

// How the answers of each model of a set were made, which must be the same for all of them.
//
// Threads: safe to call concurrently.
class Makers {
 public:
  // Stores how the first answer of a model, "name@version", was made. FAILED_PRECONDITION, with
  // what differs, if this one was made in another way.
  absl::Status Check(const std::string& model, const MadeBy& made_by);
  // The same for the answer of an item's record, if it has one.
  absl::Status CheckRecord(const v1::IndexEntry& record);

 private:
  std::mutex mutex_;
  std::map<std::string, MadeBy> first_;  // by model
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ORIGINS_H_
