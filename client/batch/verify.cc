#include "client/batch/verify.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/archive.h"
#include "client/batch/durable_file.h"
#include "client/batch/index.h"
#include "client/batch/item_files.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leader_digests.h"
#include "client/batch/made_by.h"
#include "client/batch/packing.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"
#include "client/batch/shard_list.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr size_t kProblemsKept = 100;
constexpr char kIndexFile[] = "index.jsonl";  // which is compared line by line

void AddProblem(absl::string_view problem, VerifyReport* report) {
  ++report->problem_count;
  if (report->problems.size() < kProblemsKept) report->problems.emplace_back(problem);
}

std::string AtItem(const ordered_json& record, const absl::Status& problem) {
  return absl::StrCat(record["name"].get<std::string>(), ": ", problem.message());
}

// Reads shards in the order of the index.
class ShardReader {
 public:
  explicit ShardReader(fs::path out) : out_(std::move(out)) {}

  // The next member that is an item's file.
  absl::Status Check(const std::string& shard, const std::string& path, const std::string& sha256) {
    if (shard != name_) {
      name_ = shard;
      reader_ = std::make_unique<ArchiveReader>(out_ / shard);
    }
    const absl::StatusOr<std::optional<ArchiveMember>> member = reader_->Find(path);
    if (!member.ok()) return member.status();
    if (!member->has_value()) return Wrong(path, "is not there");
    return base::Sha256Hex((*member)->content) == sha256 ? absl::OkStatus()
                                                         : Wrong(path, "was changed");
  }

 private:
  absl::Status Wrong(const std::string& path, const char* what) const {
    return absl::DataLossError(absl::StrCat((out_ / name_).string(), ": ", path, " ", what));
  }

  fs::path out_;
  std::string name_;
  std::unique_ptr<ArchiveReader> reader_;
};

// Compares files with the lines of index.jsonl.
class IndexVerifier {
 public:
  explicit IndexVerifier(const fs::path& out) : out_(out), shards_(out) {}

  void Check(const ordered_json& record) {
    ++report_.items;
    const absl::Status same_maker = makers_.CheckRecord(record);
    if (!same_maker.ok()) AddProblem(AtItem(record, same_maker), &report_);
    const std::string shard = record.value("shard", "");
    for (const ordered_json& file : record["files"]) {
      ++report_.files;
      const absl::Status status =
          shard.empty() ? CheckFile(out_ / file["path"].get<std::string>(), file["sha256"])
                        : shards_.Check(shard, file["path"], file["sha256"]);
      if (!status.ok()) AddProblem(status.message(), &report_);
    }
  }
  VerifyReport& report() { return report_; }

 private:
  fs::path out_;
  ShardReader shards_;
  Makers makers_;
  VerifyReport report_;
};

absl::StatusOr<VerifyReport> VerifyByIndex(const fs::path& out) {
  const fs::path index = out / "index.jsonl";
  std::ifstream lines(index);
  if (!lines) return absl::NotFoundError(absl::StrCat(index.string(), ": no such file"));
  const absl::StatusOr<PlannedItems> planned = ReadPlanned(out);
  if (!planned.ok()) return planned.status();
  IndexVerifier verifier(out);
  int64_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const absl::StatusOr<ordered_json> record = ParseRecord(line);
    if (record.ok() && (*record)["state"] == kDone) {
      verifier.Check(*record);
    } else {
      AddProblem(absl::StrCat(index.string(), ":", number, ": is no entry", record.ok() ? "" : ": ",
                              record.status().message()),
                 &verifier.report());
    }
  }
  verifier.report().missing = planned->missing;
  return std::move(verifier.report());
}

// Compares files, shards and index with the journal.
class JournalVerifier {
 public:
  JournalVerifier(const JobFolder& folder, const JobIdentity& identity,
                  const JournalReader& journal, const ShardList& shards)
      : folder_(folder),
        identity_(identity),
        packing_(identity.packing),
        journal_(journal),
        shards_(shards),
        files_(folder.items(identity.packing), folder.spool()),
        index_(folder.out() / kIndexFile) {}

  absl::StatusOr<VerifyReport> VerifyAll() {
    if (!index_) Problem("index.jsonl: no such file");
    if (journal_.damaged_lines() > 0) {
      Problem(absl::StrCat(".duet-batch/journal: ", journal_.damaged_lines(), " damaged lines"));
    }
    absl::Status status =
        journal_.ForEach([this](const JournalEntry& entry) { return CheckItem(entry); });
    if (!status.ok()) return status;
    if (std::string rest; index_ && std::getline(index_, rest)) IndexDiffers();
    for (size_t number = 0; number < shards_.shards().size(); ++number) {
      status = CheckShard(number);
      if (!status.ok()) return status;
    }
    const absl::StatusOr<PlannedItems> planned = ReadPlanned(folder_.out());
    if (!planned.ok()) {
      Problem(planned.status().message());
    } else {
      report_.missing = std::max<int64_t>(0, planned->count - journal_.count());
      CompareFiles(*planned);
    }
    return std::move(report_);
  }

 private:
  void Problem(absl::string_view what) { AddProblem(what, &report_); }

  absl::Status CheckItem(const JournalEntry& entry) {
    absl::StatusOr<ordered_json> record = ParseRecord(entry.record);
    if (!record.ok()) {
      Problem(
          absl::StrCat(".duet-batch/journal: item ", entry.item, ": ", record.status().message()));
      report_.damage.items.insert(entry.item);
      return absl::OkStatus();
    }
    const absl::Status same_leader = leaders_.CheckRecord(*record);
    if (!same_leader.ok()) Problem(same_leader.message());
    const absl::Status same_maker = makers_.CheckRecord(*record);
    if (!same_maker.ok()) Problem(AtItem(*record, same_maker));
    if ((*record)["state"] != kDone) return absl::OkStatus();
    ++report_.items;
    const ordered_json& files = (*record)["files"];
    report_.files += static_cast<int64_t>(files.size());
    for (size_t i = 0; shards_.ShardOf(entry.item) == ShardList::kNone && i < files.size(); ++i) {
      const absl::StatusOr<std::string> content = files_.Read(*record, entry.place, i);
      if (content.ok()) continue;
      Problem(content.status().message());
      report_.damage.items.insert(entry.item);
    }
    CheckIndexLine(entry.item, &*record);
    return absl::OkStatus();
  }

  // The files beside the index that follow from the journal. A journal that cannot be read has been
  // reported already.
  void CompareFiles(const PlannedItems& planned) {
    ComparedSetFiles files(folder_.out());
    (void)WriteIndex(journal_, identity_, shards_, planned, &files);
    for (const std::string& file : files.missing()) {
      if (file != kIndexFile) Problem(absl::StrCat(file, ": no such file"));
    }
    for (const std::string& file : files.different()) {
      if (file != kIndexFile) Problem(absl::StrCat(file, ": is not what the journal says"));
    }
  }

  void CheckIndexLine(int64_t item, ordered_json* record) {
    if (!index_ || index_differs_) return;
    std::string line;
    ++index_line_;
    const bool same =
        std::getline(index_, line) && line == IndexLine(item, identity_, shards_, record);
    if (!same) IndexDiffers();
  }

  void IndexDiffers() {
    if (!std::exchange(index_differs_, true)) {
      Problem(absl::StrCat("index.jsonl:", index_line_, ": is not what the journal says"));
    }
  }

  absl::Status CheckShard(size_t number) {
    const PackedShard& shard = shards_.shards()[number];
    if (shard.items.empty()) return absl::OkStatus();
    const std::string name = shards_.NameOf(number, packing_);
    const fs::path file = folder_.out() / name;
    const absl::StatusOr<std::string> digest = base::Sha256HexOfFile(file);
    if (digest.ok() && *digest == shard.sha256) return absl::OkStatus();
    const absl::StatusOr<std::set<int64_t>> bad = FindBadItems(journal_, shard, file);
    if (!bad.ok()) return bad.status();
    if (digest.ok() && shard.sha256.empty() && bad->empty()) return absl::OkStatus();
    std::error_code error;
    if (!fs::exists(file, error)) {
      Problem(absl::StrCat(file.string(), ": no such file"));
    } else if (bad->empty()) {
      Problem(absl::StrCat(file.string(), ": was changed, though none of its items was"));
    }
    for (const int64_t item : *bad) {
      if (fs::exists(file, error)) Problem(Describe(file, item));
    }
    report_.damage.shards.insert(name);
    report_.damage.items.insert(bad->begin(), bad->end());
    return absl::OkStatus();
  }

  std::string Describe(const fs::path& file, int64_t item) const {
    const absl::StatusOr<JournalEntry> entry = journal_.Read(item);
    std::string name = absl::StrCat("item ", item);
    if (entry.ok()) {
      const absl::StatusOr<ordered_json> record = ParseRecord(entry->record);
      if (record.ok()) name = (*record)["name"];
    }
    return absl::StrCat(file.string(), ": ", name, " is not there or was changed");
  }

  const JobFolder& folder_;
  const JobIdentity& identity_;
  const Packing packing_;
  const JournalReader& journal_;
  const ShardList& shards_;
  const ItemReader files_;
  std::ifstream index_;
  int64_t index_line_ = 0;
  bool index_differs_ = false;
  LeaderDigests leaders_;
  Makers makers_;
  VerifyReport report_;
};

}  // namespace

absl::Status CheckFile(const fs::path& path, const std::string& sha256) {
  const absl::StatusOr<std::string> content =
      base::ReadFile(path, motion::kMaxMotionFileBytes, "a motion");
  if (!content.ok()) return content.status();
  if (base::Sha256Hex(*content) == sha256) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat(path.string(), ": was changed"));
}

absl::StatusOr<VerifyReport> Verify(const fs::path& out) {
  const JobFolder folder(out);
  std::error_code error;
  if (!fs::exists(folder.journal(), error)) return VerifyByIndex(out);
  const absl::StatusOr<JobIdentity> identity = ReadJobIdentity(out);
  if (!identity.ok()) return identity.status();
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(folder.journal());
  if (!journal.ok()) return journal.status();
  const absl::StatusOr<ShardList> shards = OpenShards(*journal, *identity, folder);
  if (!shards.ok()) return shards.status();
  return JournalVerifier(folder, *identity, *journal, *shards).VerifyAll();
}

absl::Status RecordDamage(const Damage& damage, const fs::path& out) {
  JobFolder folder(out);
  absl::Status status = folder.Take();
  return status.ok() ? WriteDamage(damage, folder.damage()) : status;
}

}  // namespace duet::client::batch
