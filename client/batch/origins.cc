#include "client/batch/origins.h"

#include <vector>

#include "absl/hash/hash.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/sha256.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr char kCleanedUp[] = "cleaned_up";
constexpr char kEngine[] = "engine";
constexpr char kServerVersion[] = "server_version";
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

MadeBy MadeByOf(const SynthesisResult& result) {
  return {result.cleaned_up, result.engine, result.server_version};
}

std::optional<MadeBy> MadeByOf(const v1::IndexEntry& record) {
  if (!record.has_cleaned_up()) return std::nullopt;
  return MadeBy{record.cleaned_up(), record.engine(), record.server_version()};
}

void AddMadeBy(const MadeBy& made_by, ordered_json* record) {
  (*record)[kCleanedUp] = made_by.cleaned_up;
  if (!made_by.engine.empty()) (*record)[kEngine] = made_by.engine;
  if (!made_by.server_version.empty()) (*record)[kServerVersion] = made_by.server_version;
}

absl::Status Makers::Check(const std::string& model, const MadeBy& made_by) {
  MadeBy first;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    first = first_.try_emplace(model, made_by).first->second;
  }
  std::vector<std::string> differences;
  const auto compare = [&differences](const char* field, const std::string& expected,
                                      const std::string& got) {
    if (got == expected) return;
    differences.push_back(absl::StrCat(field, ": expected ", expected, ", got ", got));
  };
  const auto on_or_off = [](bool on) { return std::string(on ? "on" : "off"); };
  compare("clean_up", on_or_off(first.cleaned_up), on_or_off(made_by.cleaned_up));
  compare(kEngine, base::Quoted(first.engine), base::Quoted(made_by.engine));
  compare(kServerVersion, base::Quoted(first.server_version), base::Quoted(made_by.server_version));
  if (differences.empty()) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "model ", model, ": an answer was made in another way than the set's first one: ",
      absl::StrJoin(differences, "; ")));
}

absl::Status Makers::CheckRecord(const v1::IndexEntry& record) {
  const std::optional<MadeBy> made_by = MadeByOf(record);
  return made_by.has_value() ? Check(record.model(), *made_by) : absl::OkStatus();
}

}  // namespace duet::client::batch
