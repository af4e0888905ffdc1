#ifndef DUET_CLIENT_BATCH_ARCHIVE_H_
#define DUET_CLIENT_BATCH_ARCHIVE_H_

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

// A shard being written, member after member; without times and owners, so that the same members
// give the same bytes.
class Archive {
 public:
  virtual ~Archive() = default;
  // `path` has as many parts as it likes.
  virtual absl::Status Add(const std::string& path, absl::string_view content) = 0;
  // An item's record, after its files.
  virtual absl::Status AddRecord(const std::string& name, absl::string_view record) = 0;
  virtual absl::Status Finish() = 0;
};

// Of Packing::kTar: key.npy and so on and key.json of each item, one after the other, as WebDataset
// reads them. Where the motion itself is .json it is key.motion.json.
// Source: POSIX.1-2001 ustar, with pax headers for long names.
// Of Packing::kNpz: an array for each item, and "records.jsonl" with a line for each.
// Source: PKZIP application note 6.3.3, members stored as they are.
// `file` outlives the archive.
std::unique_ptr<Archive> MakeArchive(Packing packing, DurableFile* file);

// A member of a shard.
struct ArchiveMember {
  std::string path;
  std::string content;
};

// Reads what MakeArchive wrote, member after member.
class ArchiveReader {
 public:
  explicit ArchiveReader(const std::filesystem::path& path);
  // The next member; nothing at the end. DATA_LOSS for what MakeArchive did not write.
  absl::StatusOr<std::optional<ArchiveMember>> Next();
  // The next member that was added as `path`, without reading those before it; nothing where there
  // is none.
  absl::StatusOr<std::optional<ArchiveMember>> Find(const std::string& path);

 private:
  bool IsTar() const;
  // Of members of another name than `wanted`, unless that is empty, the content stays empty.
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
