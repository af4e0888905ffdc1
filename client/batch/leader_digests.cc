#include "client/batch/leader_digests.h"

#include "absl/hash/hash.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "model/base/sha256.h"

namespace duet::client::batch {
namespace {

constexpr size_t kDigits = 16;

uint64_t KeyOfFile(const LeaderEntry& leader) {
  return absl::Hash<std::string>()(leader.file.lexically_normal().string());
}

// The first 64 bits of a digest, and their text.
uint64_t FirstBits(const std::string& sha256) {
  uint64_t digest = 0;
  (void)absl::SimpleHexAtoi(sha256.substr(0, kDigits), &digest);
  return digest;
}
std::string Hex(uint64_t digest) { return absl::StrCat(absl::Hex(digest, absl::kZeroPad16)); }

}  // namespace

bool LeaderDigests::Knows(const LeaderEntry& leader) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return digests_.contains(KeyOfFile(leader));
}

absl::Status LeaderDigests::Check(const LeaderEntry& leader, const std::string& sha256) {
  const uint64_t digest = FirstBits(sha256);
  uint64_t known = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    known = digests_.try_emplace(KeyOfFile(leader), digest).first->second;
  }
  if (known == digest) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "leader ", leader.given, ": expected the file that earlier answers were made of (sha256 ",
      Hex(known), "...), got a changed one (sha256 ", sha256.substr(0, kDigits),
      "...). Restore the file, or make another data set with another "
      "--out"));
}

std::string ReadDigests::Of(const LeaderEntry& leader) {
  const uint64_t key = KeyOfFile(leader);
  const auto known = digests_.find(key);
  if (known != digests_.end()) return Hex(known->second);
  const absl::StatusOr<std::string> digest = base::Sha256HexOfFile(leader.file);
  if (!digest.ok()) return "";
  return Hex(digests_[key] = FirstBits(*digest));
}

}  // namespace duet::client::batch
