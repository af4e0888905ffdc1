#include "client/batch/verify.h"

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/archive.h"
#include "client/batch/index.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;

constexpr size_t kProblemsKept = 100;

// The shard that is being read, in the index's own order.
class ShardReader {
 public:
  explicit ShardReader(std::filesystem::path out) : out_(std::move(out)) {}

  // The next member that is a file of an item.
  absl::Status Check(const std::string& shard, const std::string& path, const std::string& sha256) {
    if (shard != name_) {
      name_ = shard;
      reader_ = std::make_unique<ArchiveReader>(out_ / shard);
    }
    while (true) {
      const absl::StatusOr<std::optional<ArchiveMember>> member = reader_->Next();
      if (!member.ok()) return member.status();
      if (!member->has_value()) return Wrong(path, "is not there");
      if ((*member)->path != path && !IsMotion(**member, path)) continue;
      return base::Sha256Hex((*member)->content) == sha256 ? absl::OkStatus()
                                                           : Wrong(path, "was changed");
    }
  }

 private:
  // name.json is name.motion.json in a tar, where name.json is the record.
  static bool IsMotion(const ArchiveMember& member, const std::string& path) {
    return absl::EndsWith(path, ".json") &&
           member.path == absl::StrCat(path.substr(0, path.size() - 5), ".motion.json");
  }
  absl::Status Wrong(const std::string& path, const char* what) const {
    return absl::DataLossError(absl::StrCat((out_ / name_).string(), ": ", path, " ", what));
  }

  std::filesystem::path out_;
  std::string name_;
  std::unique_ptr<ArchiveReader> reader_;
};

class Verifier {
 public:
  explicit Verifier(const std::filesystem::path& out) : out_(out), shards_(out) {}

  void Check(const ordered_json& record) {
    ++report_.items;
    const std::string shard = record.value("shard", "");
    for (const ordered_json& file : record["files"]) {
      ++report_.files;
      const absl::Status status =
          shard.empty() ? CheckFile(out_ / file["path"].get<std::string>(), file["sha256"])
                        : shards_.Check(shard, file["path"], file["sha256"]);
      if (status.ok()) continue;
      ++report_.problem_count;
      if (report_.problems.size() < kProblemsKept) {
        report_.problems.emplace_back(status.message());
      }
    }
  }
  VerifyReport& report() { return report_; }

 private:
  std::filesystem::path out_;
  ShardReader shards_;
  VerifyReport report_;
};

}  // namespace

absl::Status CheckFile(const std::filesystem::path& path, const std::string& sha256) {
  const absl::StatusOr<std::string> content =
      base::ReadFile(path, motion::kMaxMotionFileBytes, "a motion");
  if (!content.ok()) return content.status();
  if (base::Sha256Hex(*content) == sha256) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat(path.string(), ": was changed"));
}

absl::StatusOr<VerifyReport> Verify(const std::filesystem::path& out) {
  const std::filesystem::path index = out / "index.jsonl";
  std::ifstream lines(index);
  if (!lines) return absl::NotFoundError(absl::StrCat(index.string(), ": no such file"));
  const absl::StatusOr<PlannedItems> planned = ReadPlanned(out);
  if (!planned.ok()) return planned.status();
  Verifier verifier(out);
  int64_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const absl::StatusOr<ordered_json> record = ParseRecord(line);
    if (!record.ok() || (*record)["state"] != kDone) {
      return absl::DataLossError(absl::StrCat(index.string(), ":", number, ": is no entry",
                                              record.ok() ? "" : ": ", record.status().message()));
    }
    verifier.Check(*record);
  }
  verifier.report().missing = planned->missing;
  return verifier.report();
}

}  // namespace duet::client::batch
