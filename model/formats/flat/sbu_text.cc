#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/base/text.h"
#include "model/formats/flat/flat_files.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr int kPeople = 2;
constexpr const char* kAxes[] = {"x", "y", "z"};

// Splits one line of a file into values and tracks the column for errors.
class SbuLine {
 public:
  SbuLine(absl::string_view source, int number, absl::string_view text,
          const std::vector<std::string>& joint_names)
      : source_(source), number_(number), text_(text), joint_names_(joint_names) {}

  absl::Status CheckCount() const {
    const std::size_t expected = 1 + joint_names_.size() * 3 * kPeople;
    std::size_t count = 1;
    for (char c : text_) count += c == ',' ? 1 : 0;
    if (count == expected) return absl::OkStatus();
    return base::ErrorAt(
        source_, number_,
        absl::StrCat("expected ", expected, " comma-separated values (a frame number, then ",
                     joint_names_.size(),
                     " joints x (x, y, z) of the left and of the right person), got ", count));
  }

  absl::Status ReadFrameNumber(int* value) {
    const absl::string_view field = NextField();
    if (base::ParseInteger(field, value)) return absl::OkStatus();
    return base::ErrorAt(
        source_, number_, 1,
        absl::StrCat("frame number: expected a whole number, got ", base::Quoted(field)));
  }

  absl::Status ReadPosition(int person, std::size_t joint, motion::Vec3* position) {
    float* const axes[] = {&position->x, &position->y, &position->z};
    for (int axis = 0; axis < 3; ++axis) {
      const int column = column_;
      const absl::string_view field = NextField();
      if (!motion::ParseCoordinate(field, axes[axis])) {
        return base::ErrorAt(
            source_, number_, column,
            absl::StrCat(person == 0 ? "left" : "right", " person's ", joint_names_[joint], " ",
                         kAxes[axis], ": ", motion::ExpectedCoordinate(field)));
      }
    }
    return absl::OkStatus();
  }

 private:
  absl::string_view NextField() {
    const std::size_t start = static_cast<std::size_t>(column_ - 1);
    const absl::string_view rest = text_.substr(start);
    const absl::string_view field = rest.substr(0, rest.find(','));
    column_ += static_cast<int>(field.size()) + 1;
    return field;
  }

  absl::string_view source_;
  int number_;
  absl::string_view text_;
  const std::vector<std::string>& joint_names_;
  int column_ = 1;
};

// Checks that frame numbers increase by the step between the first two.
class FrameNumbers {
 public:
  absl::Status Accept(absl::string_view source, int line, int number) {
    if (count_ == 1) step_ = number - last_;
    if (count_ >= 1 && (step_ <= 0 || number - last_ != step_)) {
      return base::ErrorAt(source, line, 1,
                           absl::StrCat("frame number: expected ",
                                        step_ > 0 ? absl::StrCat(last_ + step_) : "a larger one",
                                        " after ", last_, ", got ", number));
    }
    last_ = number;
    ++count_;
    return absl::OkStatus();
  }

 private:
  int count_ = 0, last_ = 0, step_ = 0;
};

absl::Status ReadPeople(SbuLine* line, const SbuOptions& options, SbuRecording* recording) {
  for (int person = 0; person < kPeople; ++person) {
    motion::Clip& clip = person == 0 ? recording->left : recording->right;
    std::vector<motion::Vec3> pose(options.joint_names.size());
    for (std::size_t joint = 0; joint < pose.size(); ++joint) {
      absl::Status status = line->ReadPosition(person, joint, &pose[joint]);
      if (!status.ok()) return status;
      pose[joint] = ToWorld(options.coordinates, pose[joint]);
    }
    clip.Append(pose);
  }
  return absl::OkStatus();
}

SbuRecording EmptyRecording(const SbuOptions& options) {
  motion::Clip empty;
  empty.joint_names = options.joint_names;
  empty.frame_rate_hz = options.frame_rate_hz;
  return {empty, empty};
}

void AppendPerson(const SbuOptions& options, const motion::Clip& clip, int frame,
                  std::string* out) {
  for (int joint = 0; joint < clip.joint_count(); ++joint) {
    const motion::Vec3 position = FromWorld(options.coordinates, clip.at(frame, joint));
    for (float value : {position.x, position.y, position.z}) {
      out->push_back(',');
      base::AppendNumber(out, value);
    }
  }
}

}  // namespace

absl::StatusOr<SbuRecording> ParseSbu(absl::string_view text, absl::string_view source,
                                      const SbuOptions& options) {
  absl::Status status = motion::CheckFrameRate(source, options.frame_rate_hz);
  if (!status.ok()) return status;
  SbuRecording recording = EmptyRecording(options);
  FrameNumbers frame_numbers;
  base::LineReader lines(base::SkipByteOrderMark(text));
  for (absl::string_view content; lines.Next(&content);) {
    if (absl::StripAsciiWhitespace(content).empty()) continue;
    if (recording.left.frame_count() >= motion::kMaxMotionFrames) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
    }
    SbuLine line(source, lines.number(), content, options.joint_names);
    int number = 0;
    status = line.CheckCount();
    if (status.ok()) status = line.ReadFrameNumber(&number);
    if (status.ok()) status = frame_numbers.Accept(source, lines.number(), number);
    if (status.ok()) status = ReadPeople(&line, options, &recording);
    if (!status.ok()) return status;
  }
  if (recording.left.poses.empty()) {
    return base::ErrorAt(source, 1, "expected at least one line, got none");
  }
  return recording;
}

absl::StatusOr<SbuRecording> ReadSbu(const std::filesystem::path& path, const SbuOptions& options) {
  absl::StatusOr<std::string> text = base::ReadFile(path, motion::kMaxMotionFileBytes, "a motion");
  if (!text.ok()) return text.status();
  return ParseSbu(*text, path.string(), options);
}

absl::StatusOr<std::string> FormatSbu(const SbuRecording& recording, const SbuOptions& options) {
  const motion::Clip& left = recording.left;
  const motion::Clip& right = recording.right;
  if (left.poses.all().size() != right.poses.all().size() ||
      left.joint_names != right.joint_names) {
    return absl::InvalidArgumentError(absl::StrCat(
        "recording: expected the same frames and joints on both sides, got ", left.frame_count(),
        " frames of ", left.joint_count(), " joints on the left and ", right.frame_count(), " of ",
        right.joint_count(), " on the right"));
  }
  std::string text;
  for (int frame = 0; frame < left.frame_count(); ++frame) {
    absl::StrAppend(&text, frame + 1);
    AppendPerson(options, left, frame, &text);
    AppendPerson(options, right, frame, &text);
    text.push_back('\n');
  }
  return text;
}

}  // namespace duet::formats::flat
