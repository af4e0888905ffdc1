#include "model/formats/flat/csv.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kPrefixes[] = {"leader.", "follower."};
constexpr const char* kSuffixes[] = {"_x", "_y", "_z"};
constexpr std::size_t kMaxColumns = std::size_t{motion::kMaxFileJoints} * 6 + 2;

// Where a column's values go; person -1: nowhere.
struct Column {
  int person = -1;
  int joint = 0;
  int axis = 0;
};

absl::string_view Unquoted(absl::string_view field) {
  field = absl::StripAsciiWhitespace(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
    field = field.substr(1, field.size() - 2);
  }
  return field;
}

class CsvParser {
 public:
  CsvParser(absl::string_view text, absl::string_view source)
      : lines_(base::SkipByteOrderMark(text)), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Parse() {
    for (absl::string_view line; lines_.Next(&line);) {
      line = absl::StripAsciiWhitespace(line);
      if (line.empty()) continue;
      absl::Status status = ParseLine(line);
      if (!status.ok()) return status;
    }
    if (columns_.empty()) return Error("no header line, wanted frame,head_x,head_y,head_z,...");
    if (motion_.people[0].poses.empty()) return Error("no frames after the header line");
    for (motion::Clip& person : motion_.people) person.frame_rate_hz = frame_rate_hz_;
    return std::move(motion_);
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, std::max(lines_.number(), 1), message);
  }
  // `column` counts fields, from 1.
  absl::Status ErrorInColumn(std::size_t column, absl::string_view message) const {
    return Error(absl::StrCat("column ", column, ": ", message));
  }

  absl::Status UnknownName(absl::string_view setting, absl::string_view came,
                           absl::string_view wanted) const {
    return Error(absl::StrCat(setting, ": came ", base::Quoted(came), ", wanted ", wanted));
  }

  absl::Status ParseLine(absl::string_view line) {
    if (line[0] == '#') return ParseComment(line.substr(1));
    if (columns_.empty()) return ParseHeader(line);
    return ParseFrame(line);
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
        return Error(absl::StrCat(key, ": came ", base::Quoted(value),
                                  ", wanted more than 0 and at most ", motion::kMaxFrameRateHz));
      }
    } else if (key == "unit") {
      const std::optional<motion::LengthUnit> unit = motion::ParseLengthUnit(value);
      if (!unit.has_value()) return UnknownName(key, value, motion::kLengthUnitNames);
      motion_.coordinates.unit = *unit;
    } else if (key == "up_axis") {
      const std::optional<motion::UpAxis> axis = motion::ParseUpAxis(value);
      if (!axis.has_value()) return UnknownName(key, value, motion::kUpAxisNames);
      motion_.coordinates.up_axis = *axis;
    }
    return absl::OkStatus();
  }

  absl::Status ParseHeader(absl::string_view line) {
    const std::vector<absl::string_view> fields = absl::StrSplit(line, ',');
    if (fields.size() > kMaxColumns) {
      return Error(absl::StrCat("came ", fields.size(), " columns, wanted at most ", kMaxColumns));
    }
    std::set<std::string> seen;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::string name(Unquoted(fields[i]));
      if (!seen.insert(name).second) {
        return ErrorInColumn(i + 1, absl::StrCat(base::Quoted(name), " comes twice"));
      }
      absl::Status status = AddColumn(i + 1, name);
      if (!status.ok()) return status;
    }
    return CheckColumns();
  }

  absl::Status AddColumn(std::size_t number, absl::string_view name) {
    columns_.emplace_back();
    if (name == "frame" || name == "time") return absl::OkStatus();
    Column& column = columns_.back();
    const bool prefixed =
        absl::StartsWith(name, kPrefixes[0]) || absl::StartsWith(name, kPrefixes[1]);
    absl::string_view joint = name;
    column.person = absl::ConsumePrefix(&joint, kPrefixes[1]) ? 1 : 0;
    absl::ConsumePrefix(&joint, kPrefixes[0]);
    column.axis = -1;
    for (int axis = 0; axis < 3 && column.axis < 0; ++axis) {
      if (absl::ConsumeSuffix(&joint, kSuffixes[axis])) column.axis = axis;
    }
    if (column.axis < 0 || joint.empty()) {
      return ErrorInColumn(number,
                           absl::StrCat("came ", base::Quoted(name),
                                        ", wanted frame, time or JOINT_x, JOINT_y, JOINT_z"));
    }
    (prefixed ? has_prefixed_ : has_plain_) = true;
    column.joint = JointIndex(static_cast<size_t>(column.person), joint);
    return absl::OkStatus();
  }

  int JointIndex(std::size_t person, absl::string_view name) {
    while (motion_.people.size() <= person) motion_.people.emplace_back();
    std::vector<std::string>& names = motion_.people[person].joint_names;
    const auto it = std::find(names.begin(), names.end(), name);
    if (it != names.end()) return static_cast<int>(it - names.begin());
    names.emplace_back(name);
    return static_cast<int>(names.size()) - 1;
  }

  absl::Status CheckColumns() const {
    if (motion_.people.empty()) return Error("no joint columns, wanted JOINT_x, JOINT_y, JOINT_z");
    if (has_prefixed_ && has_plain_) {
      return Error("columns with and without \"leader.\" or \"follower.\", wanted one kind");
    }
    for (std::size_t person = 0; person < motion_.people.size(); ++person) {
      absl::Status status = CheckAxes(static_cast<int>(person));
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status CheckAxes(int person) const {
    const std::vector<std::string>& names = motion_.people[static_cast<size_t>(person)].joint_names;
    std::vector<int> axes(names.size(), 0);
    for (const Column& column : columns_) {
      if (column.person == person) axes[static_cast<size_t>(column.joint)] |= 1 << column.axis;
    }
    for (std::size_t joint = 0; joint < axes.size(); ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        if ((axes[joint] >> axis & 1) != 0) continue;
        return Error(absl::StrCat("no column ", has_prefixed_ ? kPrefixes[person] : "",
                                  names[joint], kSuffixes[axis]));
      }
    }
    if (names.empty()) return Error("no leader columns beside the follower's");
    return absl::OkStatus();
  }

  absl::Status ParseFrame(absl::string_view line) {
    const std::vector<absl::string_view> fields = absl::StrSplit(line, ',');
    if (fields.size() != columns_.size()) {
      return Error(absl::StrCat("came ", fields.size(), " values, wanted ", columns_.size(),
                                " as in the header line"));
    }
    if (motion_.people[0].frame_count() >= motion::kMaxMotionFrames) {
      return Error(absl::StrCat("more than ", motion::kMaxMotionFrames, " frames"));
    }
    for (motion::Clip& person : motion_.people) {
      person.Append(std::vector<motion::Vec3>(person.joint_names.size()));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (columns_[i].person < 0) continue;
      if (!motion::ParseCoordinate(Unquoted(fields[i]), Destination(columns_[i]))) {
        return ErrorInColumn(
            i + 1, absl::StrCat("came ", base::Quoted(fields[i]), ", wanted a finite number"));
      }
    }
    return absl::OkStatus();
  }

  float* Destination(const Column& column) {
    motion::Clip& person = motion_.people[static_cast<size_t>(column.person)];
    motion::Vec3& position = person.at(person.frame_count() - 1, column.joint);
    return column.axis == 0 ? &position.x : column.axis == 1 ? &position.y : &position.z;
  }

  base::LineReader lines_;
  absl::string_view source_;
  motion::RecordedMotion motion_;
  double frame_rate_hz_ = 0;
  std::vector<Column> columns_;
  bool has_prefixed_ = false, has_plain_ = false;
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

std::string FormatCsv(const motion::ClipPair& pair) {
  std::string text = "# duet motion: frame_rate_hz=";
  base::AppendNumber(&text, pair.leader.frame_rate_hz);
  absl::StrAppend(&text, " unit=", LengthUnitName(motion::LengthUnit::kMetres),
                  " up_axis=", UpAxisName(motion::UpAxis::kYUp), "\nframe");
  AppendHeader(kPrefixes[0], pair.leader, &text);
  AppendHeader(kPrefixes[1], pair.follower, &text);
  text += '\n';
  for (int frame = 0; frame < pair.leader.frame_count(); ++frame) {
    absl::StrAppend(&text, frame);
    AppendFrame(pair.leader, frame, &text);
    AppendFrame(pair.follower, frame, &text);
    text += '\n';
  }
  return text;
}

}  // namespace duet::formats::flat
