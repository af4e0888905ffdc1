#include "client/batch/packing.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/batch/archive.h"
#include "client/batch/durable_file.h"
#include "client/batch/record.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Fills one shard after the other.
class Packer {
 public:
  Packer(Packing packing, uint64_t shard_bytes, fs::path items, fs::path temporary, fs::path out)
      : packing_(packing),
        names_(packing, shard_bytes),
        items_(std::move(items)),
        temporary_(std::move(temporary)),
        out_(std::move(out)) {}

  absl::Status Add(const std::string& text) {
    const ordered_json record = ordered_json::parse(text);
    if (record["state"] != kDone) return absl::OkStatus();
    uint64_t bytes = 0;
    for (const ordered_json& file : record["files"]) bytes += file["bytes"].get<uint64_t>();
    const std::string name = names_.Next(bytes);
    if (name != name_) {
      absl::Status status = FinishShard();
      if (status.ok()) status = BeginShard(name);
      if (!status.ok()) return status;
    }
    return exists_ ? Forget(record) : AddItem(record);
  }

  absl::Status FinishShard() {
    if (file_ == nullptr) return absl::OkStatus();
    absl::Status status = archive_->Finish();
    if (status.ok()) status = file_->Finish(out_ / name_);
    file_.reset();
    for (const fs::path& packed : packed_) {
      std::error_code error;
      if (status.ok()) fs::remove(packed, error);
    }
    packed_.clear();
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

  absl::Status AddItem(const ordered_json& record) {
    for (const ordered_json& file : record["files"]) {
      const std::string path = file["path"];
      const absl::StatusOr<std::string> content =
          base::ReadFile(items_ / path, motion::kMaxMotionFileBytes, "a motion");
      if (!content.ok()) return content.status();
      if (base::Sha256Hex(*content) != file["sha256"]) {
        return absl::DataLossError(absl::StrCat((items_ / path).string(), ": was changed"));
      }
      absl::Status status = archive_->Add(path, *content);
      if (!status.ok()) return status;
      packed_.push_back(items_ / path);
    }
    return archive_->AddRecord(record["name"], Line(record) + "\n");
  }

  absl::Status Forget(const ordered_json& record) {
    for (const ordered_json& file : record["files"]) {
      std::error_code error;
      fs::remove(items_ / file["path"].get<std::string>(), error);
    }
    return absl::OkStatus();
  }

  Packing packing_;
  ShardNames names_;
  fs::path items_, temporary_, out_;
  std::string name_;
  bool exists_ = false;
  std::unique_ptr<DurableFile> file_;
  std::unique_ptr<Archive> archive_;
  std::vector<fs::path> packed_;
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
                  const fs::path& items, const fs::path& temporary, const fs::path& out) {
  Packer packer(packing, shard_bytes, items, temporary, out);
  absl::Status status =
      journal.ForEach([&packer](int64_t, const std::string& record) { return packer.Add(record); });
  if (status.ok()) status = packer.FinishShard();
  std::error_code error;
  if (status.ok()) fs::remove_all(items, error);
  return status;
}

}  // namespace duet::client::batch
