#include "model/formats/flat/csv.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "model/formats/flat/csv_header.h"
#include "model/formats/flat/csv_joint_rows.h"
#include "model/formats/flat/csv_times.h"
#include "model/formats/flat/utf16.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kPrefixes[] = {"leader.", "follower."};
constexpr const char* kSuffixes[] = {"_x", "_y", "_z"};
constexpr std::size_t kMaxColumns = std::size_t{motion::kMaxFileJoints} * 6 + 2;
constexpr std::size_t kMostHeaderRows = 3;
// Far beyond kMaxColumns names or numbers.
constexpr std::size_t kLongestLine = std::size_t{4} << 20;

float* AxisOf(motion::Vec3* position, int axis) {
  return axis == 0 ? &position->x : axis == 1 ? &position->y : &position->z;
}

class CsvParser {
 public:
  CsvParser(absl::string_view text, absl::string_view source)
      : lines_(base::SkipByteOrderMark(text)), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Parse() {
    absl::Status status = ParseHeader();
    CsvRow row;
    while (status.ok() && NextRow(&row, &status)) {
      status = header_.row_for_each_joint ? ParseJointRow(row) : ParseFrameRow(row);
    }
    if (status.ok() && header_.row_for_each_joint) status = CollectFrames();
    if (!status.ok()) return status;
    if (motion_.people[0].poses.empty())
      return Error("expected at least 1 frame after the header line, got none");
    motion_.rate_from_times = frame_rate_hz_ <= 0;
    const double rate = motion_.rate_from_times ? times_.FrameRate() : frame_rate_hz_;
    for (motion::Clip& person : motion_.people) person.frame_rate_hz = rate;
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

  // Returns first the rows that ParseLevels read beyond the header.
  bool NextRow(CsvRow* row, absl::Status* status) {
    if (next_waiting_ < waiting_.size()) {
      *row = std::move(waiting_[next_waiting_++]);
      return true;
    }
    absl::string_view line;
    if (!NextLine(&line, status)) return false;
    *row = SplitRow(line, delimiter_);
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
    std::vector<CsvRow> rows = {SplitRow(line, delimiter_)};
    if (rows[0].size() > kMaxColumns) {
      return Error(
          absl::StrCat("expected at most ", kMaxColumns, " columns, got ", rows[0].size()));
    }
    return NeedsFurtherRows(rows[0]) ? ParseLevels(std::move(rows)) : TakeHeader(rows);
  }

  // Whether the first row names no axis, which means that the columns have several levels.
  static bool NeedsFurtherRows(const CsvRow& row) { return !ReadHeader({row}).ok(); }

  absl::Status ParseLevels(std::vector<CsvRow> rows) {
    const absl::Status as_one_row = TakeHeader({rows[0]});
    absl::Status status;
    CsvRow row;
    while (rows.size() < kMostHeaderRows && NextRow(&row, &status)) rows.push_back(row);
    if (!status.ok()) return status;
    const std::size_t count = CountHeaderRows(rows);
    if (count == 1) return as_one_row;
    waiting_.assign(rows.begin() + static_cast<std::ptrdiff_t>(count), rows.end());
    rows.resize(count);
    status = TakeHeader(rows);
    if (!status.ok()) return status;
    if (waiting_.empty() && NextRow(&row, &status)) waiting_.push_back(row);
    if (waiting_.empty()) return status;
    const std::optional<CsvColumn::Kind> index = ReadIndexName(waiting_[0]);
    if (!index.has_value()) return status;
    header_.columns[0].kind = *index;
    waiting_.erase(waiting_.begin());
    return status;
  }

  absl::Status TakeHeader(const std::vector<CsvRow>& rows) {
    absl::StatusOr<CsvHeader> header = ReadHeader(rows);
    if (!header.ok()) return Error(header.status().message());
    header_ = *std::move(header);
    motion_.people.resize(std::max<std::size_t>(header_.joint_names.size(), 1));
    for (std::size_t person = 0; person < header_.joint_names.size(); ++person) {
      motion_.people[person].joint_names = header_.joint_names[person];
    }
    return absl::OkStatus();
  }

  absl::Status CheckRow(const CsvRow& row) const {
    if (row.size() == header_.columns.size()) return absl::OkStatus();
    return Error(absl::StrCat("expected ", header_.columns.size(),
                              " values as in the header line, got ", row.size()));
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
  void AddTime(absl::string_view time) { times_.Add(WithPoint(time)); }

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

  absl::Status ParseFrameRow(const CsvRow& row) {
    absl::Status status = CheckRow(row);
    if (!status.ok()) return status;
    const int frame = motion_.people[0].frame_count();
    if (frame >= motion::kMaxMotionFrames) {
      return Error(
          absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
    }
    for (motion::Clip& person : motion_.people) {
      person.Append(std::vector<motion::Vec3>(person.joint_names.size()));
    }
    for (std::size_t i = 0; i < row.size() && status.ok(); ++i) {
      const CsvColumn& column = header_.columns[i];
      if (column.kind == CsvColumn::Kind::kTime) AddTime(row[i]);
      if (column.kind == CsvColumn::Kind::kFrame) status = CheckFrameNumber(row, i);
      if (column.kind != CsvColumn::Kind::kPosition) continue;
      motion::Vec3& at = motion_.people[static_cast<size_t>(column.person)].at(frame, column.joint);
      status = ParsePosition(row, i, AxisOf(&at, column.axis));
    }
    return status;
  }

  absl::Status ParseJointRow(const CsvRow& row) {
    absl::Status status = CheckRow(row);
    CsvJointRows::Row parsed;
    absl::string_view time;
    for (std::size_t i = 0; i < row.size() && status.ok(); ++i) {
      const CsvColumn& column = header_.columns[i];
      if (column.kind == CsvColumn::Kind::kPosition) {
        status = ParsePosition(row, i, AxisOf(&parsed.position, column.axis));
      }
      if (column.kind == CsvColumn::Kind::kFrame) {
        parsed.frame = row[i];
        status = CheckFrameNumber(row, i);
      }
      if (column.kind == CsvColumn::Kind::kTime) time = row[i];
      if (column.kind == CsvColumn::Kind::kJoint) parsed.joint = row[i];
      if (column.kind == CsvColumn::Kind::kPerson) parsed.person = row[i];
    }
    if (!status.ok()) return status;
    // Prefer the frame number: two frames may have the same rounded time.
    if (parsed.frame.empty()) parsed.frame = time;
    const absl::StatusOr<bool> new_frame = joint_rows_.Add(parsed);
    if (!new_frame.ok()) return Error(new_frame.status().message());
    if (*new_frame && !time.empty()) AddTime(time);
    return absl::OkStatus();
  }

  absl::Status CollectFrames() {
    absl::StatusOr<std::vector<motion::Clip>> people = joint_rows_.Collect();
    if (!people.ok()) return Error(people.status().message());
    motion_.people = *std::move(people);
    return absl::OkStatus();
  }

  base::LineReader lines_;
  absl::string_view source_;
  std::optional<char> separator_;  // that the first line states
  char delimiter_ = ',';
  CsvHeader header_;
  std::vector<CsvRow> waiting_;
  std::size_t next_waiting_ = 0;
  motion::RecordedMotion motion_;
  double frame_rate_hz_ = 0;  // from a comment
  CsvTimes times_;
  CsvJointRows joint_rows_;
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

// One person without a prefix, or a leader and a follower.
std::string Format(const std::vector<const motion::Clip*>& people) {
  std::string text = "# duet motion: frame_rate_hz=";
  base::AppendNumber(&text, people[0]->frame_rate_hz);
  absl::StrAppend(&text, " unit=", LengthUnitName(motion::LengthUnit::kMetres),
                  " up_axis=", UpAxisName(motion::UpAxis::kYUp), "\nframe");
  for (std::size_t i = 0; i < people.size(); ++i) {
    AppendHeader(people.size() == 1 ? "" : kPrefixes[i], *people[i], &text);
  }
  text += '\n';
  for (int frame = 0; frame < people[0]->frame_count(); ++frame) {
    absl::StrAppend(&text, frame);
    for (const motion::Clip* person : people) AppendFrame(*person, frame, &text);
    text += '\n';
  }
  return text;
}

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseCsv(absl::string_view text, absl::string_view source) {
  const std::optional<std::string> converted = FromUtf16(text);
  return CsvParser(converted.has_value() ? *converted : text, source).Parse();
}

std::string FormatCsv(const motion::ClipPair& pair) {
  return Format({&pair.leader, &pair.follower});
}

std::string FormatCsv(const motion::Clip& person) { return Format({&person}); }

}  // namespace duet::formats::flat
