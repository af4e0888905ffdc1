#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "model/formats/flat/flat_files.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kPrefixes[] = {"leader.", "follower."};
constexpr std::array<const char*, 3> kSuffixes = {"_x", "_y", "_z"};
constexpr std::size_t kMaxColumns = std::size_t{motion::kMaxFileJoints} * 6 + 2;
// Far beyond kMaxColumns names or numbers.
constexpr std::size_t kLongestLine = std::size_t{4} << 20;

using CsvRow = std::vector<absl::string_view>;

CsvRow SplitRow(absl::string_view line) {
  CsvRow fields = absl::StrSplit(line, ',');
  for (absl::string_view& field : fields) field = absl::StripAsciiWhitespace(field);
  return fields;
}

class CsvParser {
 public:
  CsvParser(absl::string_view text, absl::string_view source)
      : lines_(base::SkipByteOrderMark(text)), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Parse() {
    absl::Status status = ParseHeader();
    absl::string_view line;
    while (status.ok() && NextLine(&line, &status)) {
      status = ParseRow(SplitRow(line));
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
      *line = absl::StripAsciiWhitespace(*line);
      if (line->empty()) continue;
      if (line->front() != '#') return true;
      *status = ParseComment(line->substr(1));
      if (!status->ok()) return false;
    }
    return false;
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
    const CsvRow names = SplitRow(line);
    if (names.size() > kMaxColumns) {
      return Error(absl::StrCat("expected at most ", kMaxColumns, " columns, got ", names.size()));
    }
    while (ignored_ < names.size() && (names[ignored_] == "frame" || names[ignored_] == "time")) {
      ++ignored_;
    }
    for (std::size_t i = ignored_; i < names.size(); i += kSuffixes.size()) {
      status = AddJoint(names, i);
      if (!status.ok()) return status;
    }
    return motion_.people.empty() ? Error("columns: expected JOINT_x, JOINT_y, JOINT_z, got none")
                                  : absl::OkStatus();
  }

  // Adds the joint whose columns begin at `first`.
  absl::Status AddJoint(const CsvRow& names, std::size_t first) {
    absl::string_view joint = names[first];
    bool whole = absl::ConsumeSuffix(&joint, kSuffixes[0]) && !joint.empty();
    for (std::size_t axis = 1; axis < kSuffixes.size(); ++axis) {
      whole = whole && first + axis < names.size() &&
              names[first + axis] == absl::StrCat(joint, kSuffixes[axis]);
    }
    if (!whole) {
      return Error(absl::StrCat("column ", first + 1,
                                ": expected JOINT_x, JOINT_y and JOINT_z side by side, got ",
                                base::Quoted(names[first])));
    }
    const bool leads = absl::ConsumePrefix(&joint, kPrefixes[0]);
    const bool follows = absl::ConsumePrefix(&joint, kPrefixes[1]);
    if (motion_.people.empty()) has_prefixes_ = leads || follows;
    if (has_prefixes_ != (leads || follows) || (follows && motion_.people.empty())) {
      return Error(absl::StrCat("column ", first + 1,
                                ": expected all columns without a prefix, or the leader's with "
                                "\"leader.\" and then the follower's with \"follower.\", got ",
                                base::Quoted(names[first])));
    }
    if (motion_.people.size() < (follows ? 2U : 1U)) motion_.people.emplace_back();
    std::vector<std::string>& joints = motion_.people[follows ? 1 : 0].joint_names;
    if (std::find(joints.begin(), joints.end(), joint) != joints.end() ||
        (leads && motion_.people.size() > 1)) {
      return Error(absl::StrCat("column ", first + 1, ": expected another joint, got ",
                                base::Quoted(names[first]), " again or after the follower's"));
    }
    joints.emplace_back(joint);
    columns_ = first + kSuffixes.size();
    return absl::OkStatus();
  }

  absl::Status ParseRow(const CsvRow& row) {
    if (row.size() != columns_) {
      return Error(
          absl::StrCat("expected ", columns_, " values as in the header line, got ", row.size()));
    }
    if (motion_.people[0].frame_count() >= motion::kMaxMotionFrames) {
      return Error(
          absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
    }
    std::size_t column = ignored_;
    for (motion::Clip& person : motion_.people) {
      std::vector<motion::Vec3> pose(person.joint_names.size());
      for (motion::Vec3& at : pose) {
        for (float* axis : {&at.x, &at.y, &at.z}) {
          const absl::string_view field = row[column++];
          if (motion::ParseCoordinate(field, axis)) continue;
          return Error(absl::StrCat("column ", column, ": ", motion::ExpectedCoordinate(field)));
        }
      }
      person.Append(pose);
    }
    return absl::OkStatus();
  }

  base::LineReader lines_;
  absl::string_view source_;
  std::size_t ignored_ = 0;  // columns of frame numbers and times, before the positions
  std::size_t columns_ = 0;
  bool has_prefixes_ = false;
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
