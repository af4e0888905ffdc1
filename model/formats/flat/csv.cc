#include "model/formats/flat/csv.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/printable.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kPrefixes[] = {"leader.", "follower."};
constexpr const char* kSuffixes[] = {"_x", "_y", "_z"};
constexpr char kNameSeparators[] = "_.:-| ";
constexpr std::size_t kMaxColumns = std::size_t{motion::kMaxFileJoints} * 6 + 2;
// Far beyond kMaxColumns names or numbers.
constexpr std::size_t kLongestLine = std::size_t{4} << 20;

using CsvRow = std::vector<absl::string_view>;

struct CsvColumn {
  enum class Kind { kPassedOver, kFrame, kPosition };
  Kind kind = Kind::kPassedOver;
  int person = 0, joint = 0, axis = 0;  // of a position
};

float* AxisOf(motion::Vec3* position, int axis) {
  return axis == 0 ? &position->x : axis == 1 ? &position->y : &position->z;
}

bool IsOneOf(absl::string_view text, std::initializer_list<absl::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [text](absl::string_view word) { return absl::EqualsIgnoreCase(text, word); });
}

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

// The first of comma, semicolon and tab in a header line; a comma if it has none.
char FindDelimiter(absl::string_view line) {
  for (char delimiter : {',', ';', '\t'}) {
    if (absl::StrContains(line, delimiter)) return delimiter;
  }
  return ',';
}

// Removes the axis from a name: "head_x" -> head and x. Returns -1 if the name does not end in an
// axis. Separators are _ . : - | and space, or none before a capital: "headX".
int TakeAxis(absl::string_view* name) {
  if (name->size() < 2) return -1;
  const unsigned char last = name->back(), before = (*name)[name->size() - 2];
  const int axis = absl::ascii_tolower(last) - 'x';
  if (axis < 0 || axis > 2) return -1;
  const bool separated = absl::StrContains(kNameSeparators, static_cast<char>(before));
  if (!separated && (!absl::ascii_isupper(last) || absl::ascii_isupper(before))) return -1;
  name->remove_suffix(separated ? 2 : 1);
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

// The columns of a header line, and the joints of each person in it.
class CsvHeader {
 public:
  absl::Status Read(const CsvRow& names) {
    std::set<absl::string_view> seen;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!seen.insert(names[i]).second) {
        return absl::InvalidArgumentError(absl::StrCat(
            "column ", i + 1, ": expected a new name, got ", base::Quoted(names[i]), " again"));
      }
      absl::Status status = AddColumn(i + 1, names[i]);
      if (!status.ok()) return status;
    }
    if (joint_names_.empty()) {
      return absl::InvalidArgumentError(
          "columns: expected JOINT_x, JOINT_y, JOINT_z, got no joint");
    }
    if (has_prefixed_ && has_plain_) {
      return absl::InvalidArgumentError(
          "columns: expected all with \"leader.\" or \"follower.\", or none, got both kinds");
    }
    absl::Status status;
    for (std::size_t person = 0; person < joint_names_.size() && status.ok(); ++person) {
      status = CheckAxes(person);
    }
    return status;
  }

  const std::vector<CsvColumn>& columns() const { return columns_; }
  const std::vector<std::vector<std::string>>& joint_names() const { return joint_names_; }

 private:
  absl::Status AddColumn(std::size_t number, absl::string_view name) {
    CsvColumn column;
    if (IsOneOf(name, {"frame", "frame_number"})) {
      column.kind = CsvColumn::Kind::kFrame;
    } else if (!IsOneOf(name, {"", "index", "unnamed: 0",  // as pandas names an index
                               "time", "time_s", "t", "seconds", "timestamp"})) {
      column.kind = CsvColumn::Kind::kPosition;
      absl::string_view joint = name;
      column.person = absl::ConsumePrefix(&joint, kPrefixes[1]) ? 1 : 0;
      (column.person == 1 || absl::ConsumePrefix(&joint, kPrefixes[0]) ? has_prefixed_
                                                                       : has_plain_) = true;
      column.axis = TakeAxis(&joint);
      DropPositionWord(&joint);
      if (column.axis < 0 || joint.empty()) {
        return absl::InvalidArgumentError(absl::StrCat(
            "column ", number, ": expected frame, time or JOINT_x, JOINT_y, JOINT_z, got ",
            base::Quoted(name)));
      }
      column.joint = JointIndex(static_cast<size_t>(column.person), joint);
    }
    columns_.push_back(column);
    return absl::OkStatus();
  }

  int JointIndex(std::size_t person, absl::string_view name) {
    if (joint_names_.size() <= person) joint_names_.resize(person + 1);
    std::vector<std::string>& names = joint_names_[person];
    const auto it = std::find(names.begin(), names.end(), name);
    if (it != names.end()) return static_cast<int>(it - names.begin());
    names.emplace_back(name);
    return static_cast<int>(names.size()) - 1;
  }

  absl::Status CheckAxes(std::size_t person) const {
    const std::vector<std::string>& names = joint_names_[person];
    if (names.empty()) {
      return absl::InvalidArgumentError(
          "columns: expected the leader's and the follower's, got only the follower's");
    }
    std::vector<std::vector<int>> counts(names.size(), std::vector<int>(3));
    for (const CsvColumn& column : columns_) {
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
    return absl::OkStatus();
  }

  std::vector<CsvColumn> columns_;
  std::vector<std::vector<std::string>> joint_names_;  // of each person
  bool has_prefixed_ = false, has_plain_ = false;
};

class CsvParser {
 public:
  CsvParser(absl::string_view text, absl::string_view source)
      : lines_(base::SkipByteOrderMark(text)), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Parse() {
    absl::Status status = ParseHeader();
    absl::string_view line;
    while (status.ok() && NextLine(&line, &status)) {
      status = ParseRow(SplitRow(line, delimiter_));
    }
    if (!status.ok()) return status;
    if (motion_.people[0].poses.empty())
      return Error("expected at least 1 frame after the header line, got none");
    for (motion::Clip& person : motion_.people) person.frame_rate_hz = frame_rate_hz_;
    return std::move(motion_);
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, std::max(lines_.number(), 1), message);
  }
  // `column` is the number of the field, from 1.
  absl::Status ErrorInColumn(std::size_t column, absl::string_view message) const {
    return Error(absl::StrCat("column ", column, ": ", message));
  }

  absl::Status Unexpected(absl::string_view setting, absl::string_view got,
                          absl::string_view expected) const {
    return Error(absl::StrCat(setting, ": expected ", expected, ", got ", base::Quoted(got)));
  }

  // Reads the next line that is neither empty nor a comment. Returns false at the end, or if
  // `status` fails.
  bool NextLine(absl::string_view* line, absl::Status* status) {
    while (lines_.Next(line)) {
      if (line->size() > kLongestLine) {
        *status = Error(absl::StrCat("expected a line of at most ", kLongestLine, " bytes, got ",
                                     line->size()));
        return false;
      }
      if (TakeSeparator(*line)) continue;
      *line = absl::StripAsciiWhitespace(*line);
      if (line->empty()) continue;
      if (line->front() != '#') return true;
      *status = ParseComment(line->substr(1));
      if (!status->ok()) return false;
    }
    return false;
  }

  // Spreadsheets read and write the separator as the first line: "sep=;".
  bool TakeSeparator(absl::string_view line) {
    if (lines_.number() != 1 || line.size() != 5 || !absl::StartsWithIgnoreCase(line, "sep=")) {
      return false;
    }
    separator_ = line.back();
    return true;
  }

  absl::Status ParseComment(absl::string_view comment) {
    for (absl::string_view word : absl::StrSplit(comment, absl::ByAnyChar(" \t,;"))) {
      const std::pair<absl::string_view, absl::string_view> setting =
          absl::StrSplit(word, absl::MaxSplits('=', 1));
      absl::Status status = ParseSetting(setting.first, setting.second);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status ParseSetting(absl::string_view key, absl::string_view value) {
    if (key == "frame_rate_hz" || key == "fps") {
      if (!base::ParseNumber(value, &frame_rate_hz_) ||
          !motion::CheckFrameRate("", frame_rate_hz_).ok()) {
        return Unexpected(key, value,
                          absl::StrCat("more than 0 and at most ", motion::kMaxFrameRateHz));
      }
    } else if (key == "unit") {
      const std::optional<motion::LengthUnit> unit = motion::ParseLengthUnit(value);
      if (!unit.has_value()) return Unexpected(key, value, motion::kLengthUnitNames);
      motion_.coordinates.unit = *unit;
      motion_.says_unit = true;
    } else if (key == "up_axis") {
      const std::optional<motion::UpAxis> axis = motion::ParseUpAxis(value);
      if (!axis.has_value()) return Unexpected(key, value, motion::kUpAxisNames);
      motion_.coordinates.up_axis = *axis;
      motion_.says_up_axis = true;
    }
    return absl::OkStatus();
  }

  absl::Status ParseHeader() {
    absl::Status status;
    absl::string_view line;
    if (!NextLine(&line, &status)) {
      return status.ok() ? Error("header: expected frame,head_x,head_y,head_z,..., got no line")
                         : status;
    }
    delimiter_ = separator_.value_or(FindDelimiter(line));
    const CsvRow names = SplitRow(line, delimiter_);
    if (names.size() > kMaxColumns) {
      return Error(absl::StrCat("expected at most ", kMaxColumns, " columns, got ", names.size()));
    }
    status = header_.Read(names);
    if (!status.ok()) return Error(status.message());
    motion_.people.resize(header_.joint_names().size());
    for (std::size_t person = 0; person < motion_.people.size(); ++person) {
      motion_.people[person].joint_names = header_.joint_names()[person];
    }
    return absl::OkStatus();
  }

  absl::Status ParsePosition(const CsvRow& row, std::size_t column, float* value) const {
    if (motion::ParseCoordinate(row[column], value)) return absl::OkStatus();
    if (motion::ParseCoordinate(WithPoint(row[column]), value)) return absl::OkStatus();
    return ErrorInColumn(column + 1, motion::ExpectedCoordinate(row[column]));
  }

  // Converts a decimal comma ("0,05"), as many European spreadsheets write it. If commas separate
  // the columns, such a field was quoted.
  static std::string WithPoint(absl::string_view field) {
    std::string text(field);
    if (std::count(text.begin(), text.end(), ',') == 1) {
      std::replace(text.begin(), text.end(), ',', '.');
    }
    return text;
  }

  // Programs write a number that they do not have as "nan".
  absl::Status CheckFrameNumber(const CsvRow& row, std::size_t column) const {
    absl::string_view word = row[column];
    absl::ConsumePrefix(&word, "-");
    for (absl::string_view bad : {"nan", "inf", "infinity"}) {
      if (!absl::EqualsIgnoreCase(word, bad)) continue;
      return ErrorInColumn(column + 1, absl::StrCat("frame number: expected a number, got ",
                                                    base::Quoted(row[column])));
    }
    return absl::OkStatus();
  }

  absl::Status ParseRow(const CsvRow& row) {
    if (row.size() != header_.columns().size()) {
      return Error(absl::StrCat("expected ", header_.columns().size(),
                                " values as in the header line, got ", row.size()));
    }
    const int frame = motion_.people[0].frame_count();
    if (frame >= motion::kMaxMotionFrames) {
      return Error(
          absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
    }
    for (motion::Clip& person : motion_.people) {
      person.Append(std::vector<motion::Vec3>(person.joint_names.size()));
    }
    absl::Status status;
    for (std::size_t i = 0; i < row.size() && status.ok(); ++i) {
      const CsvColumn& column = header_.columns()[i];
      if (column.kind == CsvColumn::Kind::kFrame) status = CheckFrameNumber(row, i);
      if (column.kind != CsvColumn::Kind::kPosition) continue;
      motion::Vec3& at = motion_.people[static_cast<size_t>(column.person)].at(frame, column.joint);
      status = ParsePosition(row, i, AxisOf(&at, column.axis));
    }
    return status;
  }
  base::LineReader lines_;
  absl::string_view source_;
  std::optional<char> separator_;  // that the first line states
  char delimiter_ = ',';
  CsvHeader header_;
  motion::RecordedMotion motion_;
  double frame_rate_hz_ = 0;  // from a comment; 0: none
};

void AppendHeader(absl::string_view prefix, const motion::Clip& clip, std::string* out) {
  for (const std::string& joint : clip.joint_names) {
    for (const char* suffix : kSuffixes) absl::StrAppend(out, ",", prefix, joint, suffix);
  }
}

void AppendFrame(const motion::Clip& clip, int frame, std::string* out) {
  for (int joint = 0; joint < clip.joint_count(); ++joint) {
    const motion::Vec3 position = clip.at(frame, joint);
    for (float value : {position.x, position.y, position.z}) {
      out->push_back(',');
      base::AppendNumber(out, value);
    }
  }
}

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseCsv(absl::string_view text, absl::string_view source) {
  return CsvParser(text, source).Parse();
}

std::string FormatCsv(const std::vector<motion::Clip>& people) {
  std::string text = "# duet motion: frame_rate_hz=";
  base::AppendNumber(&text, people[0].frame_rate_hz);
  absl::StrAppend(&text, " unit=", LengthUnitName(motion::LengthUnit::kMetres),
                  " up_axis=", UpAxisName(motion::UpAxis::kYUp), "\nframe");
  for (std::size_t i = 0; i < people.size(); ++i) {
    AppendHeader(people.size() == 1 ? "" : kPrefixes[i], people[i], &text);
  }
  text += '\n';
  for (int frame = 0; frame < people[0].frame_count(); ++frame) {
    absl::StrAppend(&text, frame);
    for (const motion::Clip& person : people) AppendFrame(person, frame, &text);
    text += '\n';
  }
  return text;
}

}  // namespace duet::formats::flat
