#ifndef DUET_CLIENT_BATCH_JOURNAL_H_
#define DUET_CLIENT_BATCH_JOURNAL_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// The final results of items: a file of lines that is only appended to.
//
//   <first 8 hex digits of the SHA-256 of the rest> <item number> <record as JSON>
//
// Truncated lines and lines that do not match their digest are ignored. After a crash, this is the
// last line; other lines were damaged later.

// Maximum number of items of a plan, and the upper bound of item numbers. A journal of this size
// takes half a GiB of memory.
inline constexpr int64_t kMaxItems = int64_t{1} << 26;

// A snapshot of the journal. Takes 8 bytes of memory for each item.
//
// Threads: const methods are safe to call concurrently.
class JournalReader {
 public:
  // A missing journal is empty. Damaged lines are skipped: their items have an earlier record, or
  // none. DATA_LOSS for an item number that no plan can have.
  static absl::StatusOr<JournalReader> Open(const std::filesystem::path& path);

  bool Has(int64_t item) const;
  // The last record of an item. Requires Has(item).
  absl::StatusOr<std::string> Read(int64_t item) const;
  // Visits every item and its record, in their order. Stops at the first error and returns it.
  absl::Status ForEach(
      const std::function<absl::Status(int64_t item, const std::string& record)>& visit) const;

  // The number after the largest item number, and the number of items with a record.
  int64_t end() const { return static_cast<int64_t>(offsets_.size()); }
  int64_t count() const { return count_; }
  // Bytes up to the end of the last complete line.
  uint64_t size() const { return size_; }

 private:
  explicit JournalReader(std::filesystem::path path) : path_(std::move(path)) {}
  absl::Status Load(std::istream* file);
  absl::StatusOr<std::string> ReadFrom(std::istream* file, int64_t item) const;

  std::filesystem::path path_;
  std::vector<uint64_t> offsets_;  // of items' lines, plus 1; 0: none
  int64_t count_ = 0;
  uint64_t size_ = 0;
};

// Appends to a journal.
class JournalWriter {
 public:
  JournalWriter() = default;
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;
  ~JournalWriter();

  // Truncates the journal to `size`, which a reader returned. ABORTED.
  absl::Status Open(const std::filesystem::path& path, uint64_t size);
  void Add(int64_t item, absl::string_view record);
  // Flushes the added records to disk. ABORTED; after an error, the journal accepts no more
  // records.
  absl::Status Commit();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string pending_;
  absl::Status broken_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_JOURNAL_H_
