#include "client/batch/item_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "client/batch/archive.h"
#include "client/batch/durable_file.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// A file for each item: written under temporary names, flushed together and renamed.
class FolderWriter final : public ItemWriter {
 public:
  FolderWriter(fs::path temporary, const fs::path& items)
      : temporary_(std::move(temporary)), items_(items.string() + "/") {}

  ~FolderWriter() override {
    for (const Pending& file : pending_) unlink(file.temporary.c_str());
  }

  absl::StatusOr<SpoolPlace> Add(const std::vector<ItemFile>& files) override {
    for (const ItemFile& file : files) {
      pending_.push_back({absl::StrCat(temporary_.string(), "/", count_++), items_ + file.path});
      absl::Status status = WriteFileUnsynced(pending_.back().temporary, file.content);
      if (!status.ok()) return status;
    }
    return SpoolPlace();
  }

  absl::Status Commit() override {
    if (pending_.empty()) return absl::OkStatus();
    absl::Status status = SyncFileSystem(temporary_);
    if (!status.ok()) return status;
    std::set<std::string> folders;
    for (const Pending& file : pending_) {
      status = RenameInto(file.temporary, file.path);
      if (!status.ok()) return status;
      folders.insert(file.path.substr(0, file.path.rfind('/')));
    }
    pending_.clear();
    for (const std::string& folder : folders) status.Update(SyncFolder(folder));
    return status;
  }

 private:
  struct Pending {
    std::string temporary, path;
  };
  const fs::path temporary_;
  const std::string items_;
  std::vector<Pending> pending_;
  int64_t count_ = 0;
};

class SpoolWriter final : public ItemWriter {
 public:
  explicit SpoolWriter(fs::path spool) : file_(std::move(spool)) {}

  absl::StatusOr<SpoolPlace> Add(const std::vector<ItemFile>& files) override {
    absl::Status status = file_.Open();
    const uint64_t place = file_.size();
    for (const ItemFile& file : files) {
      if (status.ok()) status = file_.Append(file.content);
    }
    if (!status.ok()) return status;
    return SpoolPlace(place);
  }

  absl::Status Commit() override { return file_.Commit(); }

 private:
  AppendedFile file_;
};

}  // namespace

std::unique_ptr<ItemWriter> MakeItemWriter(const JobFolder& folder, Packing packing) {
  if (packing == Packing::kNone) {
    return std::make_unique<FolderWriter>(folder.temporary(), folder.items(packing));
  }
  return std::make_unique<SpoolWriter>(folder.spool());
}

ItemReader::ItemReader(fs::path items, const fs::path& spool)
    : items_(std::move(items)),
      spool_(spool),
      descriptor_(open(spool.c_str(), O_RDWR | O_CLOEXEC)) {}

ItemReader::~ItemReader() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::StatusOr<std::string> ItemReader::ReadSpool(uint64_t offset, uint64_t bytes) const {
  std::string content(bytes, '\0');
  for (size_t done = 0; done < content.size();) {
    const ssize_t got = pread(descriptor_, content.data() + done, content.size() - done,
                              static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return absl::DataLossError(absl::StrCat(spool_.string(), ": is truncated"));
    done += static_cast<size_t>(got);
  }
  return content;
}

void ItemReader::LookInShards(fs::path out, Packing packing, const ShardList* shards) {
  out_ = std::move(out);
  packing_ = packing;
  shards_ = shards;
}

absl::StatusOr<std::string> ItemReader::Read(const ordered_json& record, const SpoolPlace& place,
                                             size_t file) const {
  absl::StatusOr<std::string> content = ReadOutside(record, place, file);
  if (content.ok() || shards_ == nullptr) return content;
  return ReadShard(record, file);
}

absl::StatusOr<std::string> ItemReader::ReadShard(const ordered_json& record, size_t file) const {
  const ordered_json& recorded = record["files"][file];
  const std::string path = recorded["path"];
  const size_t shard = shards_->ShardOf(record["item"].get<int64_t>());
  if (shard == ShardList::kNone) return absl::NotFoundError(path + ": is not in any shard");
  const fs::path archive = out_ / shards_->NameOf(shard, packing_);
  absl::StatusOr<std::optional<ArchiveMember>> member = ArchiveReader(archive).Find(path);
  if (!member.ok()) return member.status();
  if (member->has_value() && base::Sha256Hex((*member)->content) == recorded["sha256"]) {
    return std::move((*member)->content);
  }
  return absl::DataLossError(absl::StrCat(archive.string(), ": ", path, ": was changed"));
}

absl::StatusOr<std::string> ItemReader::ReadOutside(const ordered_json& record,
                                                    const SpoolPlace& place, size_t file) const {
  const ordered_json& recorded = record["files"][file];
  const std::string path = recorded["path"];
  absl::StatusOr<std::string> content;
  if (place.has_value()) {
    uint64_t offset = *place;
    for (size_t i = 0; i < file; ++i) offset += record["files"][i]["bytes"].get<uint64_t>();
    content = ReadSpool(offset, recorded["bytes"].get<uint64_t>());
  } else {
    content = base::ReadFile(items_ / path, motion::kMaxMotionFileBytes, "a motion");
  }
  if (!content.ok() || base::Sha256Hex(*content) == recorded["sha256"]) return content;
  return absl::DataLossError(
      absl::StrCat(place ? absl::StrCat(spool_.string(), ": ", path) : (items_ / path).string(),
                   ": was changed"));
}

void ItemReader::Forget(const ordered_json& record, const SpoolPlace& place) {
  uint64_t bytes = 0;
  for (const ordered_json& file : record["files"]) {
    bytes += file["bytes"].get<uint64_t>();
    if (!place.has_value()) forgotten_.push_back(items_ / file["path"].get<std::string>());
  }
  if (place.has_value()) ranges_.emplace_back(*place, bytes);
}

void ItemReader::Keep() {
  forgotten_.clear();
  ranges_.clear();
}

void ItemReader::Release() {
  for (const fs::path& file : forgotten_) {
    std::error_code error;
    fs::remove(file, error);
  }
  forgotten_.clear();
  // Merges neighbours, because a hole covers only whole blocks.
  std::sort(ranges_.begin(), ranges_.end());
  for (size_t i = 0; i < ranges_.size();) {
    const uint64_t from = ranges_[i].first;
    uint64_t end = from;
    for (; i < ranges_.size() && ranges_[i].first == end; ++i) end += ranges_[i].second;
    (void)fallocate(descriptor_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                    static_cast<off_t>(from), static_cast<off_t>(end - from));
  }
  ranges_.clear();
}

}  // namespace duet::client::batch
