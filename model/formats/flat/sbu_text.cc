#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/file.h"
#include "model/base/text.h"
#include "model/formats/flat/flat_files.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr int kPeople = 2;

// Checks that frame numbers increase by the step between the first two.
class FrameNumbers {
 public:
  absl::Status Accept(absl::string_view source, int line, absl::string_view field) {
    int number = 0;
    if (!base::ParseInteger(field, &number)) {
      return base::ErrorAt(
          source, line, 1,
          absl::StrCat("frame number: expected a whole number, got ", base::Quoted(field)));
    }
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

// Appends the frame of a line to both people.
absl::Status ReadFrame(absl::string_view source, int line, absl::string_view text,
                       const SbuOptions& options, FrameNumbers* numbers, SbuRecording* recording) {
  const std::vector<absl::string_view> fields = absl::StrSplit(text, ',');
  const std::size_t joints = options.joint_names.size(), expected = 1 + joints * 3 * kPeople;
  if (fields.size() != expected) {
    return base::ErrorAt(
        source, line,
        absl::StrCat("expected ", expected, " comma-separated values (a frame number, then ",
                     joints, " joints x (x, y, z) of the left and of the right person), got ",
                     fields.size()));
  }
  absl::Status status = numbers->Accept(source, line, fields[0]);
  if (!status.ok()) return status;
  std::size_t next = 1;
  for (motion::Clip* person : {&recording->left, &recording->right}) {
    std::vector<motion::Vec3> pose(joints);
    for (std::size_t joint = 0; joint < joints; ++joint) {
      motion::Vec3& position = pose[joint];
      for (const auto& [axis, value] : {std::pair("x", &position.x), std::pair("y", &position.y),
                                        std::pair("z", &position.z)}) {
        const absl::string_view field = fields[next++];
        if (motion::ParseCoordinate(field, value)) continue;
        return base::ErrorAt(source, line, static_cast<int>(field.data() - text.data()) + 1,
                             absl::StrCat(person == &recording->left ? "left" : "right",
                                          " person's ", options.joint_names[joint], " ", axis, ": ",
                                          motion::ExpectedCoordinate(field)));
      }
      position = ToWorld(options.coordinates, position);
    }
    person->Append(pose);
  }
  return absl::OkStatus();
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
  motion::Clip empty;
  empty.joint_names = options.joint_names;
  empty.frame_rate_hz = options.frame_rate_hz;
  SbuRecording recording{empty, empty};
  FrameNumbers frame_numbers;
  base::LineReader lines(base::SkipByteOrderMark(text));
  for (absl::string_view content; lines.Next(&content);) {
    if (absl::StripAsciiWhitespace(content).empty()) continue;
    if (recording.left.frame_count() >= motion::kMaxMotionFrames) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("expected at most ", motion::kMaxMotionFrames, " frames, got more"));
    }
    status = ReadFrame(source, lines.number(), content, options, &frame_numbers, &recording);
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
