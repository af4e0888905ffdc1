#include "client/live/json_lines.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/counted.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "nlohmann/json.hpp"

namespace duet::client::live {
namespace {

constexpr int kMaxDepth = 4;
constexpr std::size_t kMaxJoints = 1000, kMaxNameBytes = 200;
constexpr double kMaxFrameRate = 1000, kMaxPosition = 1e6, kMaxWeight = 1e3;
constexpr double kLongestEaseSeconds = 10;
constexpr int64_t kMaxFrame = int64_t{1} << 40;
constexpr int64_t kMaxIndex = int64_t{1} << 30;

std::optional<float> ParseMetresPerUnit(absl::string_view name) {
  static const auto& units = *new std::map<std::string, float>{
      {"m", 1.0F}, {"metres", 1.0F}, {"cm", 0.01F}, {"mm", 0.001F}, {"millimetres", 0.001F}};
  const auto found = units.find(std::string(name));
  return found == units.end() ? std::nullopt : std::optional<float>(found->second);
}

std::optional<motion::UpAxis> ParseUp(absl::string_view name) {
  if (name == "y") return motion::UpAxis::kYUp;
  if (name == "z") return motion::UpAxis::kZUp;
  if (name == "-y") return motion::UpAxis::kYDown;
  return motion::ParseUpAxis(name);
}

absl::StatusOr<motion::Vec3> ReadPoint(const nlohmann::json& row, std::size_t index) {
  const auto is_coordinate = [](const nlohmann::json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= kMaxPosition;
  };
  if (row.is_array() && row.size() == 3 && is_coordinate(row[0]) && is_coordinate(row[1]) &&
      is_coordinate(row[2])) {
    return motion::Vec3{row[0].get<float>(), row[1].get<float>(), row[2].get<float>()};
  }
  return absl::InvalidArgumentError(absl::StrCat("positions[", index,
                                                 "]: expected three numbers within +-",
                                                 static_cast<int64_t>(kMaxPosition), ", got ",
                                                 row.is_array() ? row.dump() : base::Shown(row)));
}

// Rejects a frame before the first one or too long after it. `index`: its distance in frames.
template <typename Value>
absl::Status CheckIndex(const char* field, Value first, Value value, int64_t index) {
  if (index >= 0 && index <= kMaxIndex) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(field, ": expected at least ", first,
                                                 ", that of the first frame, and at most ",
                                                 kMaxIndex, " frames later, got ", value));
}

}  // namespace

LineReader::LineReader(int descriptor) : descriptor_(descriptor), stop_(eventfd(0, EFD_CLOEXEC)) {}

LineReader::~LineReader() { close(stop_); }

absl::StatusOr<std::optional<std::string>> LineReader::Next() {
  for (;;) {
    const std::size_t end = buffer_.find('\n', searched_);
    if (end != std::string::npos) return Take(end, end + 1);
    searched_ = buffer_.size();
    if (buffer_.size() > kMaxLineBytes) {
      return absl::InvalidArgumentError(
          absl::StrCat("expected a line of at most ", kMaxLineBytes, " bytes, got more"));
    }
    if (!Read()) break;
  }
  if (stopped_ || buffer_.empty()) return std::nullopt;
  return Take(buffer_.size(), buffer_.size());  // the last line has no end
}

void LineReader::Stop() {
  const uint64_t one = 1;
  (void)!write(stop_, &one, sizeof(one));
}

std::optional<std::string> LineReader::Take(std::size_t length, std::size_t taken) {
  std::string line = buffer_.substr(0, length);
  buffer_.erase(0, taken);
  searched_ = 0;
  return line;
}

// Returns false at the end of the input, and after Stop.
bool LineReader::Read() {
  for (;;) {
    pollfd files[] = {{descriptor_, POLLIN, 0}, {stop_, POLLIN, 0}};
    if (poll(files, 2, -1) < 0) continue;  // a signal
    if ((files[1].revents & POLLIN) != 0) {
      stopped_ = true;
      return false;
    }
    char block[1 << 16];
    const ssize_t count = read(descriptor_, block, sizeof(block));
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return false;
    buffer_.append(block, static_cast<std::size_t>(count));
    return true;
  }
}

absl::Status JsonLinesSource::InLine(const absl::Status& status) const {
  return absl::Status(status.code(),
                      absl::StrCat("standard input: line ", line_, ": ", status.message()));
}

absl::StatusOr<std::optional<nlohmann::json>> JsonLinesSource::NextObject() {
  for (;;) {
    ++line_;
    absl::StatusOr<std::optional<std::string>> line = lines_.Next();
    if (!line.ok()) return InLine(line.status());
    if (!line->has_value()) return std::nullopt;
    // Shells of Windows begin a stream with a byte order mark.
    const absl::string_view text = absl::StripAsciiWhitespace(
        line_ == 1 ? base::SkipByteOrderMark(**line) : absl::string_view(**line));
    if (text.empty()) continue;
    absl::StatusOr<nlohmann::json> object =
        base::ParseStrictJson(std::string_view(text.data(), text.size()), kMaxDepth);
    if (!object.ok()) return InLine(object.status());
    return *std::move(object);
  }
}

absl::StatusOr<LeaderFormat> JsonLinesSource::Open() {
  absl::StatusOr<std::optional<nlohmann::json>> object = NextObject();
  if (!object.ok()) return object.status();
  if (!object->has_value()) {
    return absl::InvalidArgumentError(
        "standard input: expected a line with \"joints\" and \"rate\", got no data");
  }
  absl::StatusOr<LeaderFormat> format = ReadFormat(**object);
  if (!format.ok()) return InLine(format.status());
  return format;
}

absl::StatusOr<LeaderFormat> JsonLinesSource::ReadFormat(const nlohmann::json& object) {
  base::ObjectReader reader(object, "");
  joint_names_ = reader.UniqueStrings("joints", kMaxJoints, kMaxNameBytes);
  frame_rate_hz_ = reader.Number("rate", 1, kMaxFrameRate);
  if (reader.Has("unit")) {
    metres_per_unit_ = reader.Choice<float>("unit", ParseMetresPerUnit, "m, cm or mm");
  }
  if (reader.Has("up")) {
    coordinates_.up_axis = reader.Choice<motion::UpAxis>("up", ParseUp, "y, z or -y");
  }
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  return LeaderFormat{options_.skeleton.joint_names, frame_rate_hz_};
}

absl::StatusOr<std::optional<LeaderEvent>> JsonLinesSource::Next() {
  absl::StatusOr<std::optional<nlohmann::json>> object = NextObject();
  if (!object.ok()) return object.status();
  if (!object->has_value()) return std::nullopt;
  absl::StatusOr<LeaderEvent> event =
      (*object)->contains("labels") ? ReadLabels(**object) : ReadFrame(**object);
  if (!event.ok()) return InLine(event.status());
  return *std::move(event);
}

absl::StatusOr<LeaderEvent> JsonLinesSource::ReadLabels(const nlohmann::json& object) {
  base::ObjectReader reader(object, "");
  LabelCommand command;
  const nlohmann::json& labels = reader.Object("labels");
  base::ObjectReader weights(labels, "labels");
  for (const auto& [name, value] : labels.items()) {
    command.weights.push_back(
        {name, static_cast<float>(weights.Number(name, -kMaxWeight, kMaxWeight))});
  }
  if (reader.Has("ease")) {
    command.ease = absl::Seconds(reader.Number("ease", 0, kLongestEaseSeconds));
  }
  absl::Status status = reader.Finish();
  if (status.ok()) status = weights.Finish();
  if (status.ok() && command.weights.empty()) {
    status = absl::InvalidArgumentError("labels: expected at least one class, got none");
  }
  if (!status.ok()) return status;
  return command;
}

absl::StatusOr<LeaderEvent> JsonLinesSource::ReadFrame(const nlohmann::json& object) {
  base::ObjectReader reader(object, "");
  const nlohmann::json& rows = reader.Array("positions", kMaxJoints);
  std::optional<int64_t> number;
  std::optional<double> time;
  if (reader.Has("frame")) number = reader.Int("frame", 0, kMaxFrame);
  if (reader.Has("t")) time = reader.Number("t", -1e12, 1e12);
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  absl::StatusOr<std::vector<motion::Vec3>> pose = ReadPositions(rows);
  if (!pose.ok()) return pose.status();
  if (!map_.has_value()) {
    status = MapJoints(*pose);
    if (!status.ok()) return status;
    first_frame_ = number;
    first_time_ = time;
  }
  int64_t index = next_index_;
  if (number.has_value() && first_frame_.has_value()) {
    index = *number - *first_frame_;
    status = CheckIndex("frame", *first_frame_, *number, index);
  } else if (time.has_value() && first_time_.has_value()) {
    index = std::llround((*time - *first_time_) * frame_rate_hz_);
    status = CheckIndex("t", *first_time_, *time, index);
  }
  if (!status.ok()) return status;
  next_index_ = static_cast<int>(index) + 1;
  return LeaderFrame{static_cast<int>(index), retargeting::ApplyJointMap(*map_, *pose)};
}

absl::StatusOr<std::vector<motion::Vec3>> JsonLinesSource::ReadPositions(
    const nlohmann::json& rows) {
  if (rows.size() != joint_names_.size()) {
    return absl::InvalidArgumentError(absl::StrCat("positions: expected ", joint_names_.size(),
                                                   " points, one for each joint, got ",
                                                   rows.size()));
  }
  std::vector<motion::Vec3> pose;
  for (std::size_t joint = 0; joint < rows.size(); ++joint) {
    const absl::StatusOr<motion::Vec3> point = ReadPoint(rows[joint], joint);
    if (!point.ok()) return point.status();
    pose.push_back(motion::ToWorld(coordinates_, *point * metres_per_unit_));
  }
  return pose;
}

absl::Status JsonLinesSource::MapJoints(const std::vector<motion::Vec3>& pose) {
  const motion::Poses first(static_cast<int>(pose.size()), pose);
  absl::StatusOr<retargeting::JointMap> map = retargeting::MapJoints(
      "joints", joint_names_, first, options_.skeleton, options_.joints, &joints_);
  if (!map.ok()) return map.status();
  map_ = *std::move(map);
  return absl::OkStatus();
}

absl::Status JsonLinesSink::Start(const LeaderFormat& format) {
  const nlohmann::ordered_json line = {
      {"joints", format.joint_names}, {"rate", format.frame_rate_hz}, {"unit", "m"}, {"up", "y"}};
  out_ << line.dump() << '\n';
  return Flush();
}

absl::Status JsonLinesSink::Accept(const LiveFrames& frames) {
  for (int frame = 0; frame < frames.poses.frame_count(); ++frame) {
    std::string line =
        absl::StrCat("{\"frame\": ", frames.first_frame + frame, ", \"positions\": [");
    const char* separator = "";
    for (const motion::Vec3& point : frames.poses[frame]) {
      absl::StrAppendFormat(&line, "%s[%.5f, %.5f, %.5f]", separator, point.x, point.y, point.z);
      separator = ", ";
    }
    absl::StrAppend(&line, "]}\n");
    out_ << line;
    ++frames_;
  }
  return Flush();
}

absl::StatusOr<std::vector<std::string>> JsonLinesSink::Finish(const LiveInfo& /*info*/) {
  absl::Status status = Flush();
  if (!status.ok()) return status;
  return std::vector<std::string>{
      absl::StrCat("standard output: ", base::Counted(frames_, "frame"))};
}

absl::Status JsonLinesSink::Flush() {
  out_.flush();
  if (out_.good()) return absl::OkStatus();
  return absl::AbortedError("standard output: cannot write all of it");
}

}  // namespace duet::client::live
