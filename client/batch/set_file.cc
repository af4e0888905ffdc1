#include "client/batch/set_file.h"

#include <fstream>
#include <system_error>

#include "absl/strings/str_replace.h"
#include "client/batch/durable_file.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

class WrittenSetFile final : public SetFile {
 public:
  WrittenSetFile(const fs::path& temporary, fs::path path)
      : file_(temporary), path_(std::move(path)) {}
  absl::Status Open() { return file_.Open(); }
  absl::Status Append(absl::string_view content) override { return file_.Append(content); }
  absl::Status Finish() override { return file_.Finish(path_); }

 private:
  DurableFile file_;
  fs::path path_;
};

class ComparedSetFile final : public SetFile {
 public:
  ComparedSetFile(const fs::path& out, std::string path, std::vector<std::string>* different)
      : existing_(out / path, std::ios::binary), path_(std::move(path)), different_(different) {}

  absl::Status Append(absl::string_view content) override {
    if (!same_) return absl::OkStatus();
    std::string read(content.size(), '\0');
    existing_.read(read.data(), static_cast<std::streamsize>(read.size()));
    same_ = existing_.good() && read == content;
    return absl::OkStatus();
  }
  absl::Status Finish() override {
    if (!same_ || existing_.peek() != std::ifstream::traits_type::eof()) {
      different_->push_back(path_);
    }
    return absl::OkStatus();
  }

 private:
  std::ifstream existing_;
  std::string path_;
  bool same_ = true;
  std::vector<std::string>* different_;
};

// A file that is missing is reported once, when it is begun.
class MissingSetFile final : public SetFile {
 public:
  absl::Status Append(absl::string_view) override { return absl::OkStatus(); }
  absl::Status Finish() override { return absl::OkStatus(); }
};

}  // namespace

absl::Status SetFiles::Put(const std::string& path, absl::string_view content) {
  const absl::StatusOr<std::unique_ptr<SetFile>> file = Begin(path);
  if (!file.ok()) return file.status();
  absl::Status status = (*file)->Append(content);
  return status.ok() ? (*file)->Finish() : status;
}

absl::StatusOr<std::unique_ptr<SetFile>> WrittenSetFiles::Begin(const std::string& path) {
  auto file = std::make_unique<WrittenSetFile>(temporary_ / absl::StrReplaceAll(path, {{"/", "-"}}),
                                               out() / path);
  const absl::Status status = file->Open();
  if (!status.ok()) return status;
  return file;
}

absl::StatusOr<std::unique_ptr<SetFile>> ComparedSetFiles::Begin(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(out() / path, error)) {
    missing_.push_back(path);
    return std::make_unique<MissingSetFile>();
  }
  return std::make_unique<ComparedSetFile>(out(), path, &different_);
}

}  // namespace duet::client::batch
