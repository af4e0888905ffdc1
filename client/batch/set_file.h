#ifndef DUET_CLIENT_BATCH_SET_FILE_H_
#define DUET_CLIENT_BATCH_SET_FILE_H_

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// The files of a data set that follow from its journal, such as the index. They are written by a
// run, and compared by a verification, with the same code.

// One of these files, from its beginning to its end.
class SetFile {
 public:
  virtual ~SetFile() = default;
  virtual absl::Status Append(absl::string_view content) = 0;
  // Call once, last.
  virtual absl::Status Finish() = 0;
};

class SetFiles {
 public:
  explicit SetFiles(std::filesystem::path out) : out_(std::move(out)) {}
  virtual ~SetFiles() = default;
  // `path`: below the data set's folder.
  virtual absl::StatusOr<std::unique_ptr<SetFile>> Begin(const std::string& path) = 0;
  // A whole file.
  absl::Status Put(const std::string& path, absl::string_view content);
  const std::filesystem::path& out() const { return out_; }

 private:
  std::filesystem::path out_;
};

// Writes the files; each replaces the one of an earlier run when it is finished. Errors: ABORTED as
// in durable_file.h.
class WrittenSetFiles final : public SetFiles {
 public:
  WrittenSetFiles(std::filesystem::path temporary, std::filesystem::path out)
      : SetFiles(std::move(out)), temporary_(std::move(temporary)) {}
  absl::StatusOr<std::unique_ptr<SetFile>> Begin(const std::string& path) override;

 private:
  std::filesystem::path temporary_;
};

// Compares the files with those that exist, and changes nothing. No errors.
class ComparedSetFiles final : public SetFiles {
 public:
  explicit ComparedSetFiles(std::filesystem::path out) : SetFiles(std::move(out)) {}
  absl::StatusOr<std::unique_ptr<SetFile>> Begin(const std::string& path) override;
  // The files that are missing or differ, in the order in which they were finished.
  const std::vector<std::string>& missing() const { return missing_; }
  const std::vector<std::string>& different() const { return different_; }

 private:
  std::vector<std::string> missing_, different_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SET_FILE_H_
