#include "client/batch/leaders.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "absl/hash/hash.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/base/text.h"
#include "model/formats/motion_file.h"
#include "model/motion/reading_setting.h"
#include "nlohmann/json.hpp"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxLineBytes = size_t{1} << 20;

// `text` with a '_' for bytes that are not UTF-8, so that JSON can hold it.
std::string AsUtf8(const std::string& text) {
  const std::string json =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return absl::StrReplaceAll(nlohmann::json::parse(json).get<std::string>(),
                             {{"\xEF\xBF\xBD", "_"}});
}

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

// Whether a file of a folder may be a leader: its extension is that of a motion and of nothing
// else.
bool MayLead(const fs::path& file) {
  const std::string extension = absl::AsciiStrToLower(file.extension().string());
  return formats::IsReadable(file) && extension != ".txt" && extension != ".json";
}

absl::Status AddFolder(const fs::path& folder, LeaderList* list) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unknown;
    const bool missing = it->is_symlink(unknown) && !it->exists(unknown);
    if ((missing || it->is_regular_file(unknown)) && MayLead(it->path())) {
      files.push_back(it->path());
    }
  }
  if (error) {
    return absl::PermissionDeniedError(absl::StrCat(folder.string(), ": ", error.message()));
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    absl::Status status = list->Add(file, file.lexically_relative(folder));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status AddInput(const fs::path& path, LeaderList* list) {
  std::error_code error;
  if (fs::is_directory(path, error)) return AddFolder(path, list);
  if (!fs::exists(path, error)) return base::MissingFile(path, "file or folder");
  if (formats::IsReadable(path)) return list->Add(path, path.filename());
  return formats::UnknownExtension(path, formats::kReadableExtensions);
}

// The columns of a line by name, without empty ones.
using Columns = std::map<std::string, std::string>;

// Removes a column and returns its value; empty if it is missing.
std::string Take(const char* name, Columns* columns) {
  const auto found = columns->find(name);
  if (found == columns->end()) return "";
  std::string value = std::move(found->second);
  columns->erase(found);
  return value;
}

// Does nothing for an empty column.
template <typename Value>
absl::Status TakeParsed(const char* name, absl::StatusOr<Value> (*parse)(absl::string_view),
                        Columns* columns, std::optional<Value>* value) {
  const std::string text = Take(name, columns);
  if (text.empty()) return absl::OkStatus();
  absl::StatusOr<Value> parsed = parse(text);
  if (!parsed.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": ", parsed.status().message()));
  }
  *value = *std::move(parsed);
  return absl::OkStatus();
}

// Fills all fields except the key.
absl::StatusOr<LeaderEntry> ToEntry(const std::filesystem::path& folder, Columns columns) {
  LeaderEntry entry;
  entry.given = Take("leader", &columns);
  if (entry.given.empty()) {
    return absl::InvalidArgumentError("leader: expected a motion file, got nothing");
  }
  const std::filesystem::path path(entry.given);
  entry.file = path.is_absolute() ? path : folder / path;
  entry.group = Take("group", &columns);
  entry.follower_start = Take("follower_start", &columns);
  if (!entry.follower_start.empty() && !ParsePoint(entry.follower_start).has_value() &&
      std::filesystem::path(entry.follower_start).is_relative()) {
    entry.follower_start = (folder / entry.follower_start).string();
  }
  std::optional<Labels> labels;
  absl::Status status = TakeParsed("labels", ParseLabels, &columns, &labels);
  status.Update(TakeParsed("leader_side", ParseSide, &columns, &entry.side));
  status.Update(
      TakeParsed("partner_direction", ParseDirection, &columns, &entry.partner_direction));
  status.Update(TakeParsed("seed", ParseSeed, &columns, &entry.seed));
  if (!status.ok()) return status;
  entry.labels = std::move(labels).value_or(Labels());
  entry.extra.assign(columns.begin(), columns.end());
  return entry;
}

class Manifest final : public LeaderSource {
 public:
  Manifest(std::unique_ptr<std::istream> in, std::filesystem::path folder, std::string name)
      : in_(std::move(in)), folder_(std::move(folder)), name_(std::move(name)) {}

  absl::StatusOr<std::optional<LeaderEntry>> Next() override {
    for (std::string line; !ended_ && ReadLine(&line);) {
      if (line.empty()) continue;
      if (header_.empty()) {
        const absl::Status begun = Begin(line);
        ended_ = !begun.ok();
        if (ended_) return At(begun);
        continue;
      }
      absl::StatusOr<LeaderEntry> entry = ParseLine(line);
      if (!entry.ok()) return At(entry.status());
      return std::optional<LeaderEntry>(*std::move(entry));
    }
    if (in_->bad()) return absl::DataLossError(absl::StrCat(name_, ": cannot be read"));
    return std::optional<LeaderEntry>();
  }

 private:
  bool ReadLine(std::string* line) {
    if (!std::getline(*in_, *line)) return false;
    if (++line_ == 1) *line = std::string(base::SkipByteOrderMark(*line));
    if (!line->empty() && line->back() == '\r') line->pop_back();
    return true;
  }

  absl::Status Begin(const std::string& line) {
    header_ = absl::StrSplit(line, '\t');
    if (std::find(header_.begin(), header_.end(), "leader") != header_.end()) {
      return absl::OkStatus();
    }
    return absl::InvalidArgumentError(absl::StrCat(
        "columns: expected leader among the names of the first line, got ", base::Quoted(line)));
  }

  absl::StatusOr<Columns> ParseRow(const std::string& line) const {
    const std::vector<std::string> cells = absl::StrSplit(line, '\t');
    if (cells.size() != header_.size()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "columns: expected ", header_.size(), " as the first line names, got ", cells.size()));
    }
    Columns columns;
    for (size_t i = 0; i < cells.size(); ++i) {
      if (!cells[i].empty()) columns[header_[i]] = cells[i];
    }
    return columns;
  }

  absl::StatusOr<LeaderEntry> ParseLine(const std::string& line) {
    if (line.size() > kMaxLineBytes) {
      return absl::InvalidArgumentError(
          absl::StrCat("line: expected at most 1 MiB, got ", line.size(), " bytes"));
    }
    absl::StatusOr<Columns> columns = ParseRow(line);
    if (!columns.ok()) return columns.status();
    const std::string id = Take("id", &*columns);
    absl::StatusOr<LeaderEntry> entry = ToEntry(folder_, *std::move(columns));
    // Bad lines register their ids too, so that a later line with the same id is reported.
    absl::StatusOr<std::string> key = KeyFor(id, entry.ok() ? entry->given : "");
    if (!entry.ok()) return entry;
    if (!key.ok()) return key.status();
    entry->key = *std::move(key);
    entry->has_id = !id.empty();
    entry->line = absl::StrCat(name_, ":", line_);
    return entry;
  }

  // The key of an id, which must be unique; without ids, the leader's path and the line number,
  // which are unique.
  absl::StatusOr<std::string> KeyFor(const std::string& id, const std::filesystem::path& leader) {
    if (!has_ids_.has_value()) has_ids_ = !id.empty();
    if (*has_ids_ != !id.empty()) {
      return absl::InvalidArgumentError(
          *has_ids_ ? "id: expected one, as on the lines before, got nothing"
                    : "id: expected none, as on the lines before, got one");
    }
    if (id.empty()) {
      return absl::StrCat(KeyOf(std::filesystem::path(leader).replace_extension()), "-", line_);
    }
    std::string key = KeyOf(id);
    if (key.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat("id: expected a name, or names separated by /, other than . and .., got ",
                       base::Quoted(id)));
    }
    if (ids_.insert(absl::Hash<std::string>()(key)).second) return key;
    return absl::InvalidArgumentError(
        absl::StrCat("id: expected one that no other line has, got ", base::Quoted(id)));
  }

  absl::Status At(const absl::Status& status) const {
    return absl::Status(status.code(), absl::StrCat(name_, ":", line_, ": ", status.message()));
  }

  const std::unique_ptr<std::istream> in_;
  std::filesystem::path folder_;
  std::string name_;
  int64_t line_ = 0;
  bool ended_ = false;  // without a header, no line can be read
  std::vector<std::string> header_;
  std::optional<bool> has_ids_;
  absl::flat_hash_set<size_t> ids_;
};

// Whether a path is the folder or below it.
bool IsWithin(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end();
}

absl::Status WithMendingField(const absl::Status& status) {
  const absl::string_view field = motion::MendingField(status);
  // The extension alone states the format.
  if (field.empty() || motion::MendingSetting(status) == motion::ReadingSetting::kFormat) {
    return status;
  }
  return absl::Status(
      status.code(),
      absl::StrCat(status.message(), "; specify it in the recipe: input { ", field, " }"));
}

absl::Status SetStart(const LeaderEntry& entry, formats::Side side, const LeaderInput& input,
                      formats::ReadOptions options, LoadedLeader* loaded) {
  if (entry.follower_start.empty() && !input.starts_as_other_person) return absl::OkStatus();
  const std::string file =
      entry.follower_start.empty() ? entry.file.string() : entry.follower_start;
  absl::StatusOr<FollowerStart> start = ReadStart(file, entry.file, side, std::move(options));
  if (!start.ok()) return WithMendingField(start.status());
  loaded->follower_start = *std::move(start);
  std::error_code error;
  if (ParsePoint(file).has_value() || fs::equivalent(file, entry.file, error)) {
    return absl::OkStatus();
  }
  absl::StatusOr<std::string> digest = base::Sha256HexOfFile(file);
  if (!digest.ok()) return digest.status();
  loaded->start_sha256 = *std::move(digest);
  return absl::OkStatus();
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

absl::StatusOr<std::unique_ptr<LeaderSource>> ListLeaders(const std::vector<std::string>& inputs) {
  auto list = std::make_unique<LeaderList>();
  for (const std::string& input : inputs) {
    absl::Status status = AddInput(input, list.get());
    if (!status.ok()) return status;
  }
  if (list->empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("leaders: expected one or more motion files, got none. Formats: ",
                     formats::kReadableExtensions));
  }
  return std::unique_ptr<LeaderSource>(std::move(list));
}

std::unique_ptr<LeaderSource> ReadManifest(std::unique_ptr<std::istream> in,
                                           const std::filesystem::path& folder,
                                           const std::string& name) {
  return std::make_unique<Manifest>(std::move(in), folder, name);
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

absl::StatusOr<FollowerStart> ReadStart(const std::string& start, const fs::path& leader,
                                        formats::Side leader_side, formats::ReadOptions options) {
  if (const std::optional<motion::Vec3> root = ParsePoint(start)) return FollowerStart(*root);
  std::error_code error;
  const bool own = fs::equivalent(start, leader, error);
  options.side = own ? OtherSide(leader_side) : formats::Side::kLeft;
  absl::StatusOr<std::vector<motion::Vec3>> pose = formats::ReadFollowerStart(start, options);
  if (!pose.ok()) return pose.status();
  return FollowerStart(*std::move(pose));
}

absl::StatusOr<LoadedLeader> LoadLeader(const LeaderEntry& entry, formats::Side side,
                                        const LeaderInput& input,
                                        const motion::Skeleton& skeleton) {
  formats::ReadOptions options = input.reading;
  options.skeleton = skeleton;
  options.side = side;
  absl::StatusOr<motion::Clip> clip = formats::ReadLeader(entry.file, options);
  if (!clip.ok()) return WithMendingField(clip.status());
  absl::StatusOr<std::string> digest = base::Sha256HexOfFile(entry.file);
  if (!digest.ok()) return digest.status();
  LoadedLeader loaded;
  loaded.clip = *std::move(clip);
  loaded.sha256 = *std::move(digest);
  absl::Status status = SetStart(entry, side, input, options, &loaded);
  if (!status.ok()) return status;
  return loaded;
}

std::shared_ptr<SharedLeader> LastLeaders::Get(const std::shared_ptr<const LeaderEntry>& entry,
                                               formats::Side side, int skeleton) {
  std::shared_ptr<SharedLeader>& last = last_[static_cast<size_t>(skeleton)];
  if (last == nullptr || !last->Is(*entry, side))
    last = std::make_shared<SharedLeader>(entry, side);
  return last;
}

}  // namespace duet::client::batch
