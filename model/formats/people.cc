#include "model/formats/people.h"

#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/motion/reading_setting.h"
#include "model/retargeting/reading_report.h"

namespace duet::formats {

absl::StatusOr<ReadPeople> ReadAllPeople(PersonReader read, const ReadOptions& options) {
  ReadPeople all;
  retargeting::ReadingReport report;
  ReadOptions first = options;
  first.side = Side::kLeft;
  first.notes = &all.notes;
  first.report = &report;
  absl::StatusOr<motion::Clip> person = read(first);
  if (!person.ok()) return person.status();
  all.people.push_back(*std::move(person));
  if (report.people < 2) return all;
  ReadOptions second = options;
  second.side = Side::kRight;
  second.notes = nullptr;
  person = read(second);
  if (!person.ok()) return person.status();
  all.people.push_back(*std::move(person));
  return all;
}

absl::Status CheckReadable(const std::filesystem::path& path, const std::optional<Format>& format) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return base::MissingFile(path);
  }
  if (std::filesystem::is_directory(path, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(path.string(), ": expected a motion file, got a folder"));
  }
  if (format.has_value() || IsReadable(path)) return absl::OkStatus();
  if (!HowToConvert(path).empty()) return UnknownExtension(path, kReadableExtensions);
  return MendedBy(UnknownExtension(path, kReadableExtensions), motion::ReadingSetting::kFormat);
}

absl::Status CheckFolderOf(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (std::filesystem::is_directory(folder, error)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(path.string(), ": there is no folder ", folder.string()));
}

}  // namespace duet::formats
