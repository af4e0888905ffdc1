#include "client/batch/leader_source.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/file_name.h"
#include "model/base/missing_file.h"
#include "model/formats/motion_file.h"
#include "model/motion/reading_setting.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr std::streamsize kLookedAtBytes = 4096;

// A list of files that is complete before the first one is returned.
class LeaderList final : public LeaderSource {
 public:
  absl::StatusOr<std::optional<LeaderEntry>> Next() override {
    if (next_ == entries_.size()) return std::optional<LeaderEntry>();
    return std::optional<LeaderEntry>(entries_[next_++]);
  }

  absl::Status Add(const fs::path& file, const fs::path& named) {
    LeaderEntry entry;
    entry.key = KeyOf(fs::path(named).replace_extension());
    entry.given = file.string();
    entry.file = file;
    if (!keys_.insert(entry.key).second) {
      // Two files differ only in their extension: the second key keeps it.
      entry.key = KeyOf(named);
      if (!keys_.insert(entry.key).second) {
        return absl::InvalidArgumentError(
            absl::StrCat(file.string(), ": name: expected a unique one, got ", entry.key,
                         ", which another leader has. Use different file names, or list one folder "
                         "above both files"));
      }
    }
    entries_.push_back(std::move(entry));
    return absl::OkStatus();
  }

  bool empty() const { return entries_.empty(); }

 private:
  std::vector<LeaderEntry> entries_;
  std::set<std::string> keys_;
  size_t next_ = 0;
};

// Whether a file in a folder looks like a motion. For .txt and .json files, which can be anything,
// the beginning decides: rows of numbers, or the names of a motion's fields.
bool LooksLikeMotion(const fs::path& file) {
  const std::string extension = absl::AsciiStrToLower(file.extension().string());
  if (extension != ".txt" && extension != ".json") return true;
  std::string beginning(kLookedAtBytes, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(beginning.data(), kLookedAtBytes);
  beginning.resize(static_cast<size_t>(in.gcount()));
  if (extension == ".json") {
    return absl::StrContains(beginning, "\"duet-motion\"") ||
           absl::StrContains(beginning, "\"joint_names\"") ||
           absl::StrContains(beginning, "\"leader\"");
  }
  absl::string_view row = absl::StripLeadingAsciiWhitespace(beginning);
  row = row.substr(0, row.find('\n'));
  return absl::StrContains(row, ',') &&
         row.find_first_not_of("0123456789+-.eE, \t\r") == absl::string_view::npos;
}

// Whether a file of a folder may be a leader. Without a format, its extension must be
// that of a motion; with one, its extension must not be that of another format.
bool MayLead(const fs::path& file, const std::optional<formats::Format>& format) {
  if (!format.has_value()) return formats::IsReadable(file);
  return formats::FormatOf(file).value_or(*format) == *format;
}

absl::Status AddFolder(const fs::path& folder, const std::optional<formats::Format>& format,
                       LeaderList* list, std::vector<std::string>* passed_over) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unknown;
    const bool missing = it->is_symlink(unknown) && !it->exists(unknown);
    if ((missing || it->is_regular_file(unknown)) && MayLead(it->path(), format)) {
      files.push_back(it->path());
    }
  }
  if (error) {
    return absl::PermissionDeniedError(absl::StrCat(folder.string(), ": ", error.message()));
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    if (!LooksLikeMotion(file)) {
      if (passed_over != nullptr) passed_over->push_back(file.string());
      continue;
    }
    absl::Status status = list->Add(file, file.lexically_relative(folder));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status AddInput(const fs::path& path, const std::optional<formats::Format>& format,
                      LeaderList* list, std::vector<std::string>* passed_over) {
  std::error_code error;
  if (fs::is_directory(path, error)) return AddFolder(path, format, list, passed_over);
  if (fs::exists(path, error)) {
    if (format.has_value() || formats::IsReadable(path)) return list->Add(path, path.filename());
    return MendedBy(formats::UnknownExtension(path, formats::kReadableExtensions),
                    motion::ReadingSetting::kFormat);
  }
  return base::MissingFile(path, "file or folder");
}

// Whether a path is the folder or below it.
bool IsWithin(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end();
}

}  // namespace

std::string KeyOf(const std::filesystem::path& path) {
  std::string key;
  for (const std::filesystem::path& part : path.relative_path().lexically_normal()) {
    std::string name = AsUtf8(part.string());
    if (name.empty() || name == "." || name == "..") continue;
    for (char& c : name) {
      const auto byte = static_cast<unsigned char>(c);
      // Bytes from 0x80 on are letters of other scripts in UTF-8.
      if (!absl::ascii_isalnum(byte) && byte < 0x80 && c != '_' && c != '-' && c != '+') c = '_';
    }
    if (!key.empty()) key += '/';
    key += name;
  }
  return key;
}

absl::StatusOr<std::unique_ptr<LeaderSource>> ListLeaders(
    const std::vector<std::string>& inputs, const std::optional<formats::Format>& format,
    std::vector<std::string>* passed_over) {
  auto list = std::make_unique<LeaderList>();
  for (const std::string& input : inputs) {
    absl::Status status = AddInput(input, format, list.get(), passed_over);
    if (!status.ok()) return status;
  }
  if (list->empty()) {
    const absl::Status none = absl::InvalidArgumentError(
        absl::StrCat("leaders: expected one or more motion files, got none. Formats: ",
                     formats::kReadableExtensions));
    return format.has_value() ? none : MendedBy(none, motion::ReadingSetting::kFormat);
  }
  return std::unique_ptr<LeaderSource>(std::move(list));
}

absl::Status CheckInputs(const std::vector<std::string>& inputs, const fs::path& out) {
  std::error_code error;
  const fs::path set = fs::weakly_canonical(fs::absolute(out), error);
  for (const std::string& input : inputs) {
    if (!fs::exists(input, error)) return base::MissingFile(input, "file or folder");
    if (!fs::is_directory(input, error) || !IsWithin(set, fs::canonical(input, error))) continue;
    return absl::InvalidArgumentError(absl::StrCat("--out: expected a folder outside ", input,
                                                   ", whose files are leaders, got ", out.string(),
                                                   "; choose another folder"));
  }
  return absl::OkStatus();
}

}  // namespace duet::client::batch
