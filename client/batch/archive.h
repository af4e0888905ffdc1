#ifndef DUET_CLIENT_BATCH_ARCHIVE_H_
#define DUET_CLIENT_BATCH_ARCHIVE_H_

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/durable_file.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

// Writes a shard, member by member, without times and owners, so that the same members give the
// same bytes.
class Archive {
 public:
  virtual ~Archive() = default;
  // `path` may have any number of parts.
  virtual absl::Status Add(const std::string& path, absl::string_view content) = 0;
  // Adds the record of an item, after its files.
  virtual absl::Status AddRecord(const std::string& name, absl::string_view record) = 0;
  virtual absl::Status Finish() = 0;
};

// Packing::kTar: for each item its files (such as key.npy) and its record key.json, as WebDataset
// reads them. A motion in JSON is key.motion.json.
// Source: POSIX.1-2001 ustar, with pax headers for long names.
// Packing::kNpz: an array for each item, and "records.jsonl" with one line for each item.
// Source: PKZIP application note 6.3.3, stored members.
// `file` outlives the archive.
std::unique_ptr<Archive> MakeArchive(Packing packing, DurableFile* file);

// The names of an item's file and of its record in a tar.
std::string NameInTar(const std::string& path);
std::string RecordNameInTar(const std::string& name);
// Bytes of a member before its content, and of its content with padding.
uint64_t MemberHeaderBytes(Packing packing, const std::string& name);
uint64_t MemberContentBytes(Packing packing, uint64_t bytes);

// A member of a shard.
struct ArchiveMember {
  std::string path;
  std::string content;
};

// Reads an archive of MakeArchive, member by member.
class ArchiveReader {
 public:
  explicit ArchiveReader(const std::filesystem::path& path);
  // The next member; nullopt at the end. DATA_LOSS for anything that MakeArchive did not write.
  absl::StatusOr<std::optional<ArchiveMember>> Next();
  // The next member that was added as `path`; skips the content of other members. nullopt if there
  // is none.
  absl::StatusOr<std::optional<ArchiveMember>> Find(const std::string& path);

 private:
  bool IsTar() const;
  // Skips the content of members with another name than `wanted`, unless that is empty.
  absl::StatusOr<std::optional<ArchiveMember>> NextOf(const std::string& wanted);
  absl::StatusOr<std::optional<ArchiveMember>> NextOfTar(const std::string& wanted);
  absl::StatusOr<std::optional<ArchiveMember>> NextOfZip(const std::string& wanted);
  bool Read(size_t bytes, std::string* out);
  bool Skip(size_t bytes);
  absl::Status Damaged() const;

  std::filesystem::path path_;
  std::ifstream file_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ARCHIVE_H_
