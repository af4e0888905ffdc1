#include "client/batch/manifest.h"

#include <algorithm>
#include <cstdint>
#include <istream>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "absl/hash/hash.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/batch/text_values.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

constexpr int kJsonDepth = 8;
constexpr size_t kMaxLineBytes = size_t{1} << 20;
constexpr size_t kShownBytes = 60;  // of a line in a message
constexpr char kPins[] = "constraints";

// The columns of a JSON or TSV line by name, without empty ones.
using Columns = std::map<std::string, std::string>;

// A value of a JSON line as the text that a TSV cell would hold.
std::string CellText(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_object()) return value.dump();
  std::vector<std::string> items;
  for (const auto& [key, weight] : value.items()) {
    items.push_back(absl::StrCat(key, "=", weight.dump()));
  }
  return absl::StrJoin(items, ",");
}

// A list of texts as the text that a TSV cell would hold.
std::string ListText(const nlohmann::json& list) {
  std::vector<std::string> items;
  for (const nlohmann::json& item : list) items.push_back(CellText(item));
  return absl::StrJoin(items, ";");
}

absl::StatusOr<Columns> ParseJsonLine(const std::string& line) {
  const absl::StatusOr<nlohmann::json> object = base::ParseStrictJson(line, kJsonDepth);
  if (!object.ok() && line[0] != '{') {
    return absl::InvalidArgumentError(absl::StrCat("line: expected a JSON object, got ",
                                                   base::Quoted(line.substr(0, kShownBytes))));
  }
  if (!object.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("line: ", object.status().message()));
  }
  Columns columns;
  for (const auto& [name, value] : object->items()) {
    if (value.is_null()) continue;
    const bool is_pins = name == kPins && value.is_array();
    columns[name] = is_pins ? ListText(value) : CellText(value);
  }
  return columns;
}

// Collects all errors of a line.
class LineProblems {
 public:
  void Add(absl::string_view column, absl::string_view problem) {
    problems_.push_back(absl::StrCat(column, ": ", problem));
  }
  absl::Status ToStatus() const {
    if (problems_.empty()) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrJoin(problems_, "; "));
  }

 private:
  std::vector<std::string> problems_;
};

// Removes a column and returns its value; empty if it is missing.
std::string Take(const char* name, Columns* columns) {
  const auto found = columns->find(name);
  if (found == columns->end()) return "";
  std::string value = std::move(found->second);
  columns->erase(found);
  return value;
}

template <typename Value>
void TakeParsed(const char* name, absl::StatusOr<Value> (*parse)(absl::string_view),
                Columns* columns, std::optional<Value>* value, LineProblems* problems) {
  const std::string text = Take(name, columns);
  if (text.empty()) return;
  absl::StatusOr<Value> parsed = parse(text);
  if (!parsed.ok()) return problems->Add(name, parsed.status().message());
  *value = *std::move(parsed);
}

// `side` is the earlier name of the column.
void TakeSide(Columns* columns, std::optional<formats::Side>* side, LineProblems* problems) {
  std::optional<formats::Side> earlier;
  TakeParsed("leader_side", ParseSide, columns, side, problems);
  TakeParsed("side", ParseSide, columns, &earlier, problems);
  if (side->has_value() && earlier.has_value()) {
    problems->Add("side", "expected none beside leader_side, whose earlier name it is, got one");
  }
  if (!side->has_value()) *side = earlier;
}

// Fills all fields except the key.
absl::StatusOr<LeaderEntry> ToEntry(const std::filesystem::path& folder, Columns columns) {
  LeaderEntry entry;
  LineProblems problems;
  entry.given = Take("leader", &columns);
  if (entry.given.empty()) problems.Add("leader", "expected a motion file, got nothing");
  const std::filesystem::path path(entry.given);
  entry.file = path.is_absolute() ? path : folder / path;
  entry.model = Take("model", &columns);
  entry.group = Take("group", &columns);
  entry.follower_start = Take("follower_start", &columns);
  if (!entry.follower_start.empty() && !ParsePoint(entry.follower_start).has_value() &&
      std::filesystem::path(entry.follower_start).is_relative()) {
    entry.follower_start = (folder / entry.follower_start).string();
  }
  std::optional<Labels> labels;
  TakeParsed("labels", ParseLabels, &columns, &labels, &problems);
  TakeSide(&columns, &entry.side, &problems);
  TakeParsed("follower_start_side", ParseSide, &columns, &entry.follower_start_side, &problems);
  TakeParsed("partner_direction", ParseDirection, &columns, &entry.partner_direction, &problems);
  std::optional<Pins> pins;
  TakeParsed(kPins, ParsePins, &columns, &pins, &problems);
  TakeParsed("seed", ParseSeed, &columns, &entry.seed, &problems);
  absl::Status status = problems.ToStatus();
  if (!status.ok()) return status;
  entry.labels = std::move(labels).value_or(Labels());
  entry.pins = std::move(pins).value_or(Pins());
  entry.extra.assign(columns.begin(), columns.end());
  return entry;
}

class Manifest final : public LeaderSource {
 public:
  Manifest(std::istream& in, std::filesystem::path folder, std::string name)
      : in_(in), folder_(std::move(folder)), name_(std::move(name)) {}

  absl::StatusOr<std::optional<LeaderEntry>> Next() override {
    for (std::string line; !ended_ && ReadLine(&line);) {
      if (line.empty()) continue;
      if (kind_ == Kind::kUnknown) {
        const absl::StatusOr<bool> is_entry = Begin(line);
        ended_ = !is_entry.ok();
        if (ended_) return At(is_entry.status());
        if (!*is_entry) continue;
      }
      absl::StatusOr<LeaderEntry> entry = ParseLine(line);
      if (!entry.ok()) return At(entry.status());
      return std::optional<LeaderEntry>(*std::move(entry));
    }
    if (in_.bad()) return absl::DataLossError(absl::StrCat(name_, ": cannot be read"));
    return std::optional<LeaderEntry>();
  }

 private:
  enum class Kind { kUnknown, kJson, kTsv };

  bool ReadLine(std::string* line) {
    if (!std::getline(in_, *line)) return false;
    if (++line_ == 1) *line = std::string(base::SkipByteOrderMark(*line));
    if (!line->empty() && line->back() == '\r') line->pop_back();
    return true;
  }

  // Reads the kind of the manifest from its first line. Returns whether that line is an entry.
  absl::StatusOr<bool> Begin(const std::string& line) {
    kind_ = line[0] == '{' ? Kind::kJson : Kind::kTsv;
    if (kind_ == Kind::kJson) return true;
    header_ = absl::StrSplit(line, '\t');
    if (std::find(header_.begin(), header_.end(), "leader") != header_.end()) return false;
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
    absl::StatusOr<Columns> columns = kind_ == Kind::kJson ? ParseJsonLine(line) : ParseRow(line);
    if (!columns.ok()) return columns.status();
    const std::string id = Take("id", &*columns);
    absl::StatusOr<LeaderEntry> entry = ToEntry(folder_, *std::move(columns));
    // Bad lines register their ids too, so that a later line with the same id is reported.
    absl::StatusOr<std::string> key = KeyFor(id, entry.ok() ? entry->given : "");
    if (!entry.ok() && !key.ok()) {
      return absl::InvalidArgumentError(
          absl::StrCat(entry.status().message(), "; ", key.status().message()));
    }
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

  std::istream& in_;
  std::filesystem::path folder_;
  std::string name_;
  int64_t line_ = 0;
  Kind kind_ = Kind::kUnknown;
  bool ended_ = false;  // without a header, no line can be read
  std::vector<std::string> header_;
  std::optional<bool> has_ids_;
  absl::flat_hash_set<size_t> ids_;
};

}  // namespace

std::unique_ptr<LeaderSource> ReadManifest(std::istream& in, const std::filesystem::path& folder,
                                           const std::string& name) {
  return std::make_unique<Manifest>(in, folder, name);
}

}  // namespace duet::client::batch
