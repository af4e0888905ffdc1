#include "client/batch/packing.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/batch/archive.h"
#include "client/batch/durable_file.h"
#include "client/batch/item_files.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Fills one shard after the other.
class Packer {
 public:
  Packer(Packing packing, uint64_t shard_bytes, const JobFolder& folder)
      : packing_(packing),
        names_(packing, shard_bytes),
        items_(folder.items(packing), folder.spool()),
        temporary_(folder.temporary()),
        out_(folder.out()) {}

  absl::Status Add(const JournalEntry& entry) {
    const absl::StatusOr<ordered_json> parsed = ParseRecord(entry.record);
    if (!parsed.ok()) return parsed.status();
    const ordered_json& record = *parsed;
    if (record["state"] != kDone) return absl::OkStatus();
    uint64_t bytes = 0;
    for (const ordered_json& file : record["files"]) bytes += file["bytes"].get<uint64_t>();
    const std::string name = names_.Next(bytes);
    if (name != name_) {
      absl::Status status = FinishShard();
      if (status.ok()) status = BeginShard(name);
      if (!status.ok()) return status;
    }
    items_.Forget(record, entry.place);
    return exists_ ? absl::OkStatus() : AddItem(record, entry.place);
  }

  absl::Status FinishShard() {
    absl::Status status;
    if (file_ != nullptr) {
      status = archive_->Finish();
      if (status.ok()) status = file_->Finish(out_ / name_);
      file_.reset();
    }
    if (status.ok()) items_.Release();
    return status;
  }

 private:
  absl::Status BeginShard(const std::string& name) {
    name_ = name;
    std::error_code error;
    // Only a whole shard has its name; its items may not all be gone yet.
    exists_ = fs::exists(out_ / name, error);
    if (exists_) return absl::OkStatus();
    file_ = std::make_unique<DurableFile>(temporary_ / name);
    absl::Status status = file_->Open();
    if (status.ok()) archive_ = MakeArchive(packing_, file_.get());
    return status;
  }

  absl::Status AddItem(const ordered_json& record, const SpoolPlace& place) {
    for (size_t i = 0; i < record["files"].size(); ++i) {
      const absl::StatusOr<std::string> content = items_.Read(record, place, i);
      if (!content.ok()) return content.status();
      absl::Status status = archive_->Add(record["files"][i]["path"], *content);
      if (!status.ok()) return status;
    }
    return archive_->AddRecord(record["name"], Line(record) + "\n");
  }

  Packing packing_;
  ShardNames names_;
  ItemReader items_;
  fs::path temporary_, out_;
  std::string name_;
  bool exists_ = false;
  std::unique_ptr<DurableFile> file_;
  std::unique_ptr<Archive> archive_;
};

}  // namespace

std::string ShardNames::Next(uint64_t item_bytes) {
  if (packing_ == Packing::kNone) return "";
  if (used_ > 0 && used_ + item_bytes > room_) {
    ++number_;
    used_ = 0;
  }
  used_ += item_bytes;
  return absl::StrFormat("set-%06d.%s", number_, packing_ == Packing::kTar ? "tar" : "npz");
}

bool IsPacked(Packing packing, uint64_t shard_bytes, const fs::path& out) {
  std::error_code error;
  return packing != Packing::kNone &&
         fs::exists(out / ShardNames(packing, shard_bytes).Next(0), error);
}

absl::Status Pack(const JournalReader& journal, Packing packing, uint64_t shard_bytes,
                  const JobFolder& folder) {
  Packer packer(packing, shard_bytes, folder);
  absl::Status status =
      journal.ForEach([&packer](const JournalEntry& entry) { return packer.Add(entry); });
  if (status.ok()) status = packer.FinishShard();
  std::error_code error;
  if (status.ok()) fs::remove_all(folder.items(packing), error);
  if (status.ok()) fs::remove(folder.spool(), error);
  return status;
}

}  // namespace duet::client::batch
