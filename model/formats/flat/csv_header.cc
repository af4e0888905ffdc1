#include "model/formats/flat/csv_header.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/printable.h"
#include "model/base/text.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kPrefixes[] = {"leader.", "follower."};
constexpr const char* kSuffixes[] = {"_x", "_y", "_z"};
constexpr char kNameSeparators[] = "_.:-| ";

bool IsOneOf(absl::string_view text, std::initializer_list<absl::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [text](absl::string_view word) { return absl::EqualsIgnoreCase(text, word); });
}

bool IsTime(absl::string_view name) {
  return IsOneOf(name, {"time", "time_s", "t", "seconds", "timestamp"});
}
bool IsFrame(absl::string_view name) { return IsOneOf(name, {"frame", "frame_number"}); }
// An index has no name, or the name that pandas gives it when it reads it back.
bool IsIndex(absl::string_view name) {
  return IsOneOf(name, {"", "frame", "index", "frame_number", "unnamed: 0"});
}
bool IsJointColumn(absl::string_view name) {
  return IsOneOf(name, {"joint", "bone", "joint_name", "bone_name", "joint name", "bone name",
                        "name", "marker"});
}
// Whether the column names the person of a row, in a file with a row for each joint.
bool IsPersonColumn(absl::string_view name) {
  return IsOneOf(name, {"person", "character", "armature", "rig", "object", "actor", "subject"});
}

int AxisNumber(absl::string_view text) {
  if (text.size() != 1) return -1;
  const char axis = absl::ascii_tolower(static_cast<unsigned char>(text[0]));
  return axis >= 'x' && axis <= 'z' ? axis - 'x' : -1;
}

// Removes the axis from a name: "head_x" -> head and x. Returns -1 if the name does not end in an
// axis. Separators are _ . : - | and space, or none before a capital: "headX".
int TakeAxis(absl::string_view* name) {
  if (name->size() < 2) return -1;
  const int axis = AxisNumber(name->substr(name->size() - 1));
  const char before = (*name)[name->size() - 2];
  if (axis < 0) return -1;
  if (absl::StrContains(kNameSeparators, before)) {
    name->remove_suffix(2);
    return axis;
  }
  if (!absl::ascii_isupper(static_cast<unsigned char>(name->back())) ||
      absl::ascii_isupper(static_cast<unsigned char>(before))) {
    return -1;
  }
  name->remove_suffix(1);
  return axis;
}

// Removes a word for "position": "head_location" -> head.
void DropPositionWord(absl::string_view* name) {
  for (absl::string_view word : {"location", "loc", "position", "pos"}) {
    if (name->size() <= word.size() || !absl::EndsWithIgnoreCase(*name, word)) continue;
    const char before = (*name)[name->size() - word.size() - 1];
    if (!absl::StrContains(kNameSeparators, before)) continue;
    name->remove_suffix(word.size() + 1);
    return;
  }
}

// The axis of a column of positions in a file with a row for each joint: x, loc_x, location.x, and
// head_x. Blender's name for the joint of a bone is head; the tail is the joint of the next bone.
int PlainAxis(absl::string_view name) {
  if (const int axis = AxisNumber(name); axis >= 0) return axis;
  const int axis = TakeAxis(&name);
  return IsOneOf(name, {"location", "loc", "position", "pos", "head"}) ? axis : -1;
}

// pandas writes flattened columns of several levels as "('head', 'x')".
std::string WithoutTuple(absl::string_view name) {
  if (!absl::ConsumePrefix(&name, "(") || !absl::ConsumeSuffix(&name, ")")) {
    return std::string(name);
  }
  std::vector<std::string> parts;
  for (absl::string_view part : absl::StrSplit(name, ',')) {
    part = absl::StripAsciiWhitespace(part);
    absl::ConsumePrefix(&part, "'");
    absl::ConsumeSuffix(&part, "'");
    parts.emplace_back(part);
  }
  const std::string axis = parts.back();
  parts.pop_back();
  return absl::StrCat(absl::StrJoin(parts, "."), "_", axis);
}

bool NamesAxes(const CsvRow& row) {
  bool any = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool axis = AxisNumber(row[i]) >= 0;
    // The first column may hold the name of the level.
    if (!axis && !row[i].empty() && i > 0 && !IsIndex(row[i]) && !IsTime(row[i])) return false;
    any = any || axis;
  }
  return any;
}

// Joins the names of all levels to one name per column: leader, head, x -> leader.head_x. A level's
// name applies to all columns up to its next name.
std::vector<std::string> JoinLevels(const std::vector<CsvRow>& rows) {
  std::vector<std::string> names(rows.back().begin(), rows.back().end());
  if (rows.size() == 1) return names;
  CsvRow current(rows.size(), "");  // "" because StrJoin reads data() even of an empty name
  for (std::size_t column = 0; column < names.size(); ++column) {
    for (std::size_t level = 0; level + 1 < rows.size(); ++level) {
      if (!rows[level][column].empty()) current[level] = rows[level][column];
    }
    if (AxisNumber(names[column]) < 0) {
      // An index or a time; any level may hold its name.
      for (std::size_t level = 0; level + 1 < rows.size() && names[column].empty(); ++level) {
        names[column] = std::string(rows[level][column]);
      }
      if (column == 0 && !IsTime(names[column])) names[column].clear();
      continue;
    }
    const CsvRow levels(current.begin(), current.end() - 1);
    names[column] = absl::StrCat(absl::StrJoin(levels, "."), "_", names[column]);
  }
  return names;
}

absl::Status ColumnError(std::size_t column, absl::string_view message) {
  return absl::InvalidArgumentError(absl::StrCat("column ", column + 1, ": ", message));
}

class HeaderReader {
 public:
  absl::StatusOr<CsvHeader> Read(const std::vector<std::string>& names) {
    header_.row_for_each_joint = IsRowForEachJoint(names);
    std::set<std::string> seen;
    for (std::size_t column = 0; column < names.size(); ++column) {
      if (!seen.insert(names[column]).second) {
        return ColumnError(column, absl::StrCat("expected a new name, got ",
                                                base::Quoted(names[column]), " again"));
      }
      absl::Status status = header_.row_for_each_joint ? AddPlainColumn(names[column])
                                                       : AddColumn(column, names[column]);
      if (!status.ok()) return status;
    }
    absl::Status status = header_.row_for_each_joint ? CheckPlainColumns() : CheckColumns();
    if (!status.ok()) return status;
    return std::move(header_);
  }

 private:
  static bool IsRowForEachJoint(const std::vector<std::string>& names) {
    bool axis = false;
    for (const std::string& name : names) axis = axis || PlainAxis(name) >= 0;
    return axis && std::any_of(names.begin(), names.end(), IsJointColumn);
  }

  absl::Status AddPlainColumn(absl::string_view name) {
    CsvColumn column;
    if (const int axis = PlainAxis(name); axis >= 0) {
      column.kind = CsvColumn::Kind::kPosition;
      column.axis = axis;
    } else if (IsJointColumn(name)) {
      column.kind = CsvColumn::Kind::kJoint;
    } else if (IsPersonColumn(name)) {
      column.kind = CsvColumn::Kind::kPerson;
    } else if (IsTime(name)) {
      column.kind = CsvColumn::Kind::kTime;
    } else if (IsFrame(name)) {
      column.kind = CsvColumn::Kind::kFrame;
    }
    header_.columns.push_back(column);
    return absl::OkStatus();
  }

  absl::Status CheckPlainColumns() const {
    int axes[3] = {}, joints = 0, people = 0, frames = 0;
    for (const CsvColumn& column : header_.columns) {
      if (column.kind == CsvColumn::Kind::kPosition) ++axes[column.axis];
      joints += column.kind == CsvColumn::Kind::kJoint ? 1 : 0;
      people += column.kind == CsvColumn::Kind::kPerson ? 1 : 0;
      frames += column.kind == CsvColumn::Kind::kFrame || column.kind == CsvColumn::Kind::kTime;
    }
    if (axes[0] == 1 && axes[1] == 1 && axes[2] == 1 && joints == 1 && people <= 1 && frames > 0) {
      return absl::OkStatus();
    }
    return absl::InvalidArgumentError(
        "expected one column each of joint, x, y and z, frame or time, and at most one of person "
        "in "
        "a file with a row for each joint, got other columns");
  }

  absl::Status AddColumn(std::size_t number, absl::string_view name) {
    CsvColumn column;
    if (IsTime(name)) column.kind = CsvColumn::Kind::kTime;
    if (IsFrame(name)) column.kind = CsvColumn::Kind::kFrame;
    if (!IsTime(name) && !IsIndex(name)) {
      column.kind = CsvColumn::Kind::kPosition;
      absl::string_view joint = name;
      const bool prefixed =
          absl::StartsWith(name, kPrefixes[0]) || absl::StartsWith(name, kPrefixes[1]);
      column.person = absl::ConsumePrefix(&joint, kPrefixes[1]) ? 1 : 0;
      absl::ConsumePrefix(&joint, kPrefixes[0]);
      column.axis = TakeAxis(&joint);
      DropPositionWord(&joint);
      if (column.axis < 0 || joint.empty()) {
        return ColumnError(number,
                           absl::StrCat("expected frame, time or JOINT_x, JOINT_y, JOINT_z, got ",
                                        base::Quoted(name)));
      }
      (prefixed ? has_prefixed_ : has_plain_) = true;
      column.joint = JointIndex(static_cast<size_t>(column.person), joint);
    }
    header_.columns.push_back(column);
    return absl::OkStatus();
  }

  int JointIndex(std::size_t person, absl::string_view name) {
    while (header_.joint_names.size() <= person) header_.joint_names.emplace_back();
    std::vector<std::string>& names = header_.joint_names[person];
    const auto it = std::find(names.begin(), names.end(), name);
    if (it != names.end()) return static_cast<int>(it - names.begin());
    names.emplace_back(name);
    return static_cast<int>(names.size()) - 1;
  }

  absl::Status CheckColumns() const {
    if (header_.joint_names.empty()) {
      return absl::InvalidArgumentError(
          "columns: expected JOINT_x, JOINT_y, JOINT_z, got no joint");
    }
    if (has_prefixed_ && has_plain_) {
      return absl::InvalidArgumentError(
          "columns: expected all with \"leader.\" or \"follower.\", or none, got both kinds");
    }
    for (std::size_t person = 0; person < header_.joint_names.size(); ++person) {
      absl::Status status = CheckAxes(person);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status CheckAxes(std::size_t person) const {
    const std::vector<std::string>& names = header_.joint_names[person];
    std::vector<std::vector<int>> counts(names.size(), std::vector<int>(3));
    for (const CsvColumn& column : header_.columns) {
      if (column.kind != CsvColumn::Kind::kPosition) continue;
      if (column.person != static_cast<int>(person)) continue;
      ++counts[static_cast<size_t>(column.joint)][static_cast<size_t>(column.axis)];
    }
    for (std::size_t joint = 0; joint < names.size(); ++joint) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (counts[joint][axis] == 1) continue;
        return absl::InvalidArgumentError(
            absl::StrCat(has_prefixed_ ? kPrefixes[person] : "",
                         base::Printable(names[joint], base::kLongestQuote), kSuffixes[axis],
                         ": expected one column, got ", counts[joint][axis]));
      }
    }
    if (names.empty()) {
      return absl::InvalidArgumentError(
          "columns: expected the leader's and the follower's, got only the follower's");
    }
    return absl::OkStatus();
  }

  CsvHeader header_;
  bool has_prefixed_ = false, has_plain_ = false;
};

}  // namespace

CsvRow SplitRow(absl::string_view line, char delimiter) {
  CsvRow fields;
  bool quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    // An unclosed quote ends with the row.
    if (i < line.size() && (quoted || line[i] != delimiter)) continue;
    absl::string_view field = absl::StripAsciiWhitespace(line.substr(start, i - start));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
      field = field.substr(1, field.size() - 2);
    }
    fields.push_back(field);
    start = i + 1;
  }
  return fields;
}

char FindDelimiter(absl::string_view line) {
  for (char delimiter : {',', ';', '\t'}) {
    if (absl::StrContains(line, delimiter)) return delimiter;
  }
  return ',';
}

std::size_t CountHeaderRows(const std::vector<CsvRow>& rows) {
  for (std::size_t row = 1; row < rows.size(); ++row) {
    if (rows[row].size() != rows[0].size()) break;
    if (NamesAxes(rows[row])) return row + 1;
  }
  return 1;
}

std::optional<CsvColumn::Kind> ReadIndexName(const CsvRow& row) {
  double number = 0;
  const bool alone = std::all_of(row.begin() + 1, row.end(),
                                 [](absl::string_view field) { return field.empty(); });
  if (!alone || base::ParseNumber(row[0], &number)) return std::nullopt;
  return IsTime(row[0]) ? CsvColumn::Kind::kTime : CsvColumn::Kind::kPassedOver;
}

absl::StatusOr<CsvHeader> ReadHeader(const std::vector<CsvRow>& rows) {
  std::vector<std::string> names = JoinLevels(rows);
  for (std::string& name : names) name = WithoutTuple(name);
  return HeaderReader().Read(names);
}

}  // namespace duet::formats::flat
