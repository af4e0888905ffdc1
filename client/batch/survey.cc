#include "client/batch/survey.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/hash/hash.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "model/base/sha256.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr size_t kDigits = 16;  // of a digest

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

std::string Describe(const MadeBy& made_by) {
  return absl::StrCat("clean_up ", made_by.cleaned_up ? "on" : "off", ", engine ",
                      base::Quoted(made_by.engine), ", server_version ",
                      base::Quoted(made_by.server_version));
}

// Whether only the labels may differ, which are drawn from the content of the leader: the item
// failed because of a leader that was mended since.
bool IsDrawnAnew(const v1::IndexEntry& record, const Item& item) {
  return item.drawn && record.state() == kFailed && record.leader() == item.leader->given &&
         record.name() == item.name;
}

// Whether a file is there with its size and, if it is read, with its content.
bool IsWhole(const fs::path& out, const v1::IndexEntry::File& file, bool read) {
  const fs::path path = out / file.path();
  std::error_code error;
  const uint64_t bytes = fs::file_size(path, error);
  if (error || bytes != file.bytes()) return false;
  if (!read) return true;
  const absl::StatusOr<std::string> digest = base::Sha256HexOfFile(path);
  return digest.ok() && *digest == file.sha256();
}

}  // namespace

absl::Status Survey::CheckLeader(const LeaderEntry& leader, const std::string& sha256) {
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
      "...). Restore the file, or make another data set with another --out"));
}

absl::Status Survey::CheckMaker(const std::string& model, const MadeBy& made_by) {
  const std::string now = Describe(made_by);
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string& first = makers_.try_emplace(model, now).first->second;
  if (first == now) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "model ", model, ": an answer was made in another way than the set's first one: expected ",
      first, ", got ", now, ". Use servers that are set up alike, or choose another --out"));
}

absl::StatusOr<std::unique_ptr<Survey>> Survey::Open(const JobFolder& folder,
                                                     const Repeats& repeats) {
  absl::StatusOr<JournalReader> journal = JournalReader::Open(folder.journal());
  if (!journal.ok()) return journal.status();
  return std::unique_ptr<Survey>(new Survey(folder, repeats, *std::move(journal)));
}

absl::Status Survey::Add(const Item& item) {
  if (!journal_.Has(item.number)) return absl::OkStatus();
  const absl::StatusOr<std::string> text = journal_.Read(item.number);
  if (!text.ok()) return text.status();
  const absl::StatusOr<v1::IndexEntry> record = ParseRecord(*text);
  if (!record.ok()) return absl::OkStatus();  // the run requests it again
  // A changed leader comes first, because it may also change the labels that are drawn from it.
  const bool same_leader = record->leader() == item.leader->given;
  absl::Status status = same_leader ? CheckRecorded(*item.leader, *record) : absl::OkStatus();
  if (!status.ok()) return status;
  if (record->id() != item.id && !IsDrawnAnew(*record, item)) {
    return absl::FailedPreconditionError(absl::StrCat(
        folder_.out().string(), ": item ", item.number, ": expected ", record->name(), " of ",
        record->leader(), " as the set was begun with, got ", item.name, " of ", item.leader->given,
        same_leader ? ", asked in another way" : "",
        ". Keep the leaders in their order and add new ones at the end, or use another --out"));
  }
  const std::optional<MadeBy> made_by = MadeByOf(*record);
  if (made_by.has_value()) status = CheckMaker(record->model(), *made_by);
  if (!status.ok() || !IsSettledNow(*record)) return status;
  const auto at = static_cast<size_t>(item.number);
  if (settled_.size() <= at) settled_.resize(at + 1);
  settled_[at] = true;
  return absl::OkStatus();
}

absl::Status Survey::CheckRecorded(const LeaderEntry& leader, const v1::IndexEntry& record) {
  const std::string& sha256 = record.leader_sha256();
  if (sha256.empty()) return absl::OkStatus();
  const bool first = !digests_.contains(KeyOfFile(leader));
  absl::Status status = CheckLeader(leader, sha256);
  if (!status.ok() || !first) return status;
  // Only items that are not settled need a leader that no longer exists.
  const absl::StatusOr<std::string> now = base::Sha256HexOfFile(leader.file);
  return now.ok() ? CheckLeader(leader, *now) : absl::OkStatus();
}

bool Survey::IsSettledNow(const v1::IndexEntry& record) const {
  if (record.state() == kFailed) return !repeats_.failed;
  if (record.state() == kRejected) return true;
  const auto& files = record.files();
  return std::all_of(files.begin(), files.end(), [this](const v1::IndexEntry::File& file) {
    return IsWhole(folder_.out(), file, repeats_.changed);
  });
}

}  // namespace duet::client::batch
