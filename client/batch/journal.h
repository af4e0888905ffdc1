#ifndef DUET_CLIENT_BATCH_JOURNAL_H_
#define DUET_CLIENT_BATCH_JOURNAL_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// What is known of each item for good: a file of lines, only ever appended to.
//
//   <first 8 hex digits of the SHA-256 of the rest> <item number> <record as JSON>
//   <first 8 hex digits of the SHA-256 of the rest> <item number> @<place> <record as JSON>
//
// The place is that of the item's files in the spool (item_files.h), where they are there.
//
// A line that is cut off or does not fit its digest counts as not written, wherever it stands: the
// last one is what a process was writing when it stopped, one before it was damaged later.

struct JournalEntry {
  int64_t item = 0;
  std::optional<uint64_t> place;
  std::string record;
};

// The journal as it is; 8 bytes of memory an item.
//
// Threads: const methods are safe to call concurrently.
class JournalReader {
 public:
  // A journal that is not there is empty. Damaged lines are skipped: their items have the record
  // before, or none. DATA_LOSS for an item that no plan has.
  static absl::StatusOr<JournalReader> Open(const std::filesystem::path& path);
  JournalReader(JournalReader&& other) noexcept;
  JournalReader& operator=(JournalReader&&) = delete;
  ~JournalReader();

  bool Has(int64_t item) const;
  // The record of an item that it has. Where there are several the last one.
  absl::StatusOr<JournalEntry> Read(int64_t item) const;
  // Every record, in the order of the items. Stops at what is not OK and returns it.
  absl::Status ForEach(const std::function<absl::Status(const JournalEntry&)>& visit) const;

  // One beyond the last item of which there is a record, and how many records there are.
  int64_t end() const { return static_cast<int64_t>(offsets_.size()); }
  int64_t count() const { return count_; }
  // Damaged lines, without one that was cut off at the end.
  int64_t damaged_lines() const { return damaged_lines_; }
  // Bytes up to the end of the last whole line.
  uint64_t size() const { return size_; }

 private:
  JournalReader() = default;
  absl::Status Load();
  absl::StatusOr<std::string> LineAt(uint64_t offset) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::vector<uint64_t> offsets_;  // of items' lines, plus 1; 0: none
  int64_t count_ = 0;
  int64_t damaged_lines_ = 0;
  uint64_t size_ = 0;
};

// Removes the damaged lines of a journal that has any: `temporary` receives the others and replaces
// it. Nobody else may have it open. ABORTED as of durable_file.h.
absl::Status RepairJournal(const std::filesystem::path& path,
                           const std::filesystem::path& temporary);

// Adds to a journal.
class JournalWriter {
 public:
  JournalWriter() = default;
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;
  ~JournalWriter();

  // Cuts off what is beyond `size`, a reader's. ABORTED.
  absl::Status Open(const std::filesystem::path& path, uint64_t size);
  void Add(int64_t item, absl::string_view record, std::optional<uint64_t> place = std::nullopt);
  // Brings what was added to the disk. ABORTED; after that the journal takes nothing more.
  absl::Status Commit();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string pending_;
  absl::Status broken_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOURNAL_H_
