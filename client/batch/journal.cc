#include "client/batch/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/batch/durable_file.h"
#include "model/base/sha256.h"

namespace duet::client::batch {
namespace {

constexpr size_t kDigestDigits = 8;
constexpr mode_t kFileMode = 0644;

std::string Digest(absl::string_view text) {
  return base::Sha256Hex({text.data(), text.size()}).substr(0, kDigestDigits);
}

struct ParsedLine {
  int64_t item = 0;
  absl::string_view record;
};

// Returns false for a truncated or damaged line.
bool ParseLine(absl::string_view line, ParsedLine* parsed) {
  if (line.size() < kDigestDigits + 2 || line[kDigestDigits] != ' ') return false;
  const absl::string_view rest = line.substr(kDigestDigits + 1);
  const size_t space = rest.find(' ');
  if (space == absl::string_view::npos || !absl::SimpleAtoi(rest.substr(0, space), &parsed->item) ||
      parsed->item < 0 || line.substr(0, kDigestDigits) != Digest(rest)) {
    return false;
  }
  parsed->record = rest.substr(space + 1);
  return true;
}

}  // namespace

absl::StatusOr<JournalReader> JournalReader::Open(const std::filesystem::path& path) {
  JournalReader reader(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file && errno == ENOENT) return reader;
  if (!file) return absl::ErrnoToStatus(errno, path.string());
  absl::Status status = reader.Load(&file);
  if (!status.ok()) return status;
  return reader;
}

absl::Status JournalReader::Load(std::istream* file) {
  uint64_t position = 0;
  for (std::string line; std::getline(*file, line);) {
    const uint64_t offset = position;
    position += line.size() + 1;
    ParsedLine parsed;
    // A line that reaches the end of the file has no newline.
    if (file->eof() || !ParseLine(line, &parsed)) continue;
    if (parsed.item >= kMaxItems) {
      return absl::DataLossError(absl::StrCat(path_.string(), ": byte ", offset,
                                              ": item: expected a number below ", kMaxItems,
                                              ", got ", parsed.item));
    }
    if (parsed.item >= end()) offsets_.resize(static_cast<size_t>(parsed.item) + 1);
    uint64_t& known = offsets_[static_cast<size_t>(parsed.item)];
    count_ += known == 0 ? 1 : 0;
    known = offset + 1;
    size_ = position;
  }
  if (file->bad()) return absl::DataLossError(absl::StrCat(path_.string(), ": cannot be read"));
  return absl::OkStatus();
}

bool JournalReader::Has(int64_t item) const {
  return item < end() && offsets_[static_cast<size_t>(item)] != 0;
}

absl::StatusOr<std::string> JournalReader::Read(int64_t item) const {
  std::ifstream file(path_, std::ios::binary);
  return ReadFrom(&file, item);
}

absl::StatusOr<std::string> JournalReader::ReadFrom(std::istream* file, int64_t item) const {
  file->seekg(static_cast<std::streamoff>(offsets_[static_cast<size_t>(item)] - 1));
  std::string line;
  ParsedLine parsed;
  if (std::getline(*file, line) && ParseLine(line, &parsed) && parsed.item == item) {
    return std::string(parsed.record);
  }
  return absl::DataLossError(absl::StrCat(path_.string(), ": changed while read"));
}

absl::Status JournalReader::ForEach(
    const std::function<absl::Status(int64_t item, const std::string& record)>& visit) const {
  std::ifstream file(path_, std::ios::binary);
  for (int64_t item = 0; item < end(); ++item) {
    if (!Has(item)) continue;
    const absl::StatusOr<std::string> record = ReadFrom(&file, item);
    if (!record.ok()) return record.status();
    absl::Status status = visit(item, *record);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

JournalWriter::~JournalWriter() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::Status JournalWriter::Open(const std::filesystem::path& path, uint64_t size) {
  path_ = path;
  descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kFileMode);
  if (descriptor_ < 0) return CannotWrite(path, errno);
  const auto end = static_cast<off_t>(size);
  if (ftruncate(descriptor_, end) != 0 || lseek(descriptor_, end, SEEK_SET) != end ||
      fsync(descriptor_) != 0) {
    return CannotWrite(path, errno);
  }
  return SyncFileSystem(path.parent_path());
}

void JournalWriter::Add(int64_t item, absl::string_view record) {
  const std::string rest = absl::StrCat(item, " ", record);
  absl::StrAppend(&pending_, Digest(rest), " ", rest, "\n");
}

absl::Status JournalWriter::Commit() {
  if (broken_.ok()) broken_ = WriteAll(descriptor_, pending_, path_);
  pending_.clear();
  if (broken_.ok() && fdatasync(descriptor_) != 0) broken_ = CannotWrite(path_, errno);
  return broken_;
}

}  // namespace duet::client::batch
