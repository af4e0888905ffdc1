#include "model/formats/bvh/bvh_document.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::bvh {
namespace {

// Relative. A rate that is nearer to a whole number than the first is that number, unless it is a
// rounded common rate; nearer than the second, in any case.
constexpr double kRateTolerance = 5e-4, kExact = 1e-6;
// Of a frame time whose decimals cannot be counted (1e-2): it is not taken for a rounded one.
constexpr int kManyDecimals = 9;
// With fewer decimals, exporters round: .016 is a step of 16 ms, not 1/60.
constexpr int kFewestTruncated = 4;

constexpr double kCommonRatesHz[] = {12, 15, 20, 24,  25,  30,  48, 50,
                                     60, 72, 90, 100, 120, 144, 240};

// The nearest common rate whose frame time has the decimals of `seconds`; 0 if there is none.
double NearestCommon(double seconds, int decimals) {
  const double step = std::pow(10, -decimals);
  const double truncated = decimals >= kFewestTruncated ? step : step / 2;
  double nearest = 0;
  for (double rate : kCommonRatesHz) {
    const double missing = 1 / rate - seconds;
    const bool fits = missing > -step / 2 && missing < truncated;
    if (fits && std::abs(rate - 1 / seconds) < std::abs(nearest - 1 / seconds)) nearest = rate;
  }
  return nearest;
}

constexpr int kMaxChannels = 6;
constexpr int kOffsetDecimals = 6;
constexpr int kValueDecimals = 5;
constexpr int kFrameTimeDecimals = 9;

std::optional<int> DecimalsOf(absl::string_view number) {
  const std::size_t point = number.find('.');
  if (point == absl::string_view::npos) return std::nullopt;
  const absl::string_view decimals = number.substr(point + 1);
  const bool plain = std::all_of(decimals.begin(), decimals.end(),
                                 [](unsigned char c) { return absl::ascii_isdigit(c); });
  return plain ? std::optional<int>(static_cast<int>(decimals.size())) : std::nullopt;
}

// In the order of BvhChannel.
constexpr const char* kChannelNames[] = {"Xposition", "Yposition", "Zposition",
                                         "Xrotation", "Yrotation", "Zrotation"};

std::optional<BvhChannel> FindChannel(absl::string_view name) {
  for (std::size_t i = 0; i < std::size(kChannelNames); ++i) {
    if (absl::EqualsIgnoreCase(kChannelNames[i], name)) return static_cast<BvhChannel>(i);
  }
  return std::nullopt;
}

// Reads words and lines of a text and tracks the line number.
class Cursor {
 public:
  explicit Cursor(absl::string_view text) : rest_(text) {}

  // The next word, empty at the end of the text.
  absl::string_view Word() {
    while (!rest_.empty() && absl::ascii_isspace(static_cast<unsigned char>(rest_[0]))) {
      line_ += EndsLine() ? 1 : 0;
      rest_.remove_prefix(1);
    }
    std::size_t size = 0;
    while (size < rest_.size() && !absl::ascii_isspace(static_cast<unsigned char>(rest_[size]))) {
      ++size;
    }
    return Take(size);
  }

  // The rest of the line up to a brace, stripped of white space: names may contain spaces.
  absl::string_view Name() {
    const std::size_t end = rest_.find_first_of("{}\r\n");
    return absl::StripAsciiWhitespace(Take(end == absl::string_view::npos ? rest_.size() : end));
  }

  absl::string_view rest() const { return rest_; }
  int line() const { return line_; }

 private:
  bool EndsLine() const {
    if (rest_[0] == '\r') return rest_.size() == 1 || rest_[1] != '\n';
    return rest_[0] == '\n';
  }

  absl::string_view Take(std::size_t size) {
    const absl::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  absl::string_view rest_;
  int line_ = 1;
};

class BvhParser {
 public:
  BvhParser(absl::string_view text, absl::string_view source)
      : cursor_(base::SkipByteOrderMark(text)), source_(source) {}

  absl::StatusOr<BvhDocument> Parse() {
    absl::Status status = ParseHierarchy();
    if (status.ok()) status = ParseMotionHeader();
    if (status.ok()) status = ParseFrames();
    if (!status.ok()) return status;
    return std::move(document_);
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return base::ErrorAt(source_, cursor_.line(), message);
  }

  absl::Status Unexpected(absl::string_view got, absl::string_view expected) const {
    return Error(absl::StrCat("expected ", expected, ", got ",
                              got.empty() ? "the end of the file" : base::Quoted(got)));
  }

  absl::Status ParseHierarchy() {
    const absl::string_view first = cursor_.Word();
    if (first != "HIERARCHY") return Unexpected(first, "HIERARCHY at the start of a BVH file");
    while (true) {
      const absl::string_view word = cursor_.Word();
      if (word == "MOTION" && open_.empty() && !document_.joints.empty()) return absl::OkStatus();
      absl::Status status = ParseStatement(word);
      if (!status.ok()) return status;
    }
  }

  absl::Status ParseStatement(absl::string_view word) {
    if (open_.empty()) {
      if (word == "ROOT") return OpenJoint(word, /*end_site=*/false);
      return Unexpected(word, document_.joints.empty() ? "ROOT" : "ROOT or MOTION");
    }
    const bool in_end_site = document_.joints[static_cast<size_t>(open_.back())].end_site;
    if (word == "OFFSET") return ParseOffset();
    if (word == "}") return CloseJoint();
    if (word == "CHANNELS" && !in_end_site) return ParseChannels();
    if (word == "JOINT" && !in_end_site) return OpenJoint(word, /*end_site=*/false);
    if (word == "End" && !in_end_site) return OpenJoint(word, /*end_site=*/true);
    return Unexpected(word, in_end_site ? "OFFSET or }" : "OFFSET, CHANNELS, JOINT, End Site or }");
  }

  absl::Status OpenJoint(absl::string_view keyword, bool end_site) {
    BvhJoint joint;
    joint.parent = open_.empty() ? -1 : open_.back();
    joint.end_site = end_site;
    const absl::string_view name = cursor_.Name();
    if (name.empty()) return Error(absl::StrCat(keyword, ": expected a name, got none"));
    joint.name =
        end_site ? absl::StrCat(document_.joints[static_cast<size_t>(joint.parent)].name, ".end")
                 : std::string(name);
    if (document_.joints.size() >= motion::kMaxFileJoints) {
      return Error(absl::StrCat("expected at most ", motion::kMaxFileJoints, " joints, got more"));
    }
    const absl::string_view brace = cursor_.Word();
    if (brace != "{") return Unexpected(brace, absl::StrCat("{ after ", keyword, " ", name));
    open_.push_back(static_cast<int>(document_.joints.size()));
    has_offset_.push_back(false);
    document_.joints.push_back(std::move(joint));
    return absl::OkStatus();
  }

  absl::Status CloseJoint() {
    const BvhJoint& joint = document_.joints[static_cast<size_t>(open_.back())];
    if (!has_offset_[static_cast<size_t>(open_.back())]) {
      return Error(
          absl::StrCat("joint ", base::Quoted(joint.name), ": expected an OFFSET, got none"));
    }
    open_.pop_back();
    return absl::OkStatus();
  }

  absl::Status ParseOffset() {
    float values[3] = {};
    for (float& value : values) {
      const absl::string_view word = cursor_.Word();
      if (!motion::ParseCoordinate(word, &value))
        return Unexpected(word, "a number of OFFSET x y z");
    }
    document_.joints[static_cast<size_t>(open_.back())].offset = {values[0], values[1], values[2]};
    has_offset_[static_cast<size_t>(open_.back())] = true;
    return absl::OkStatus();
  }

  absl::Status ParseChannels() {
    BvhJoint& joint = document_.joints[static_cast<size_t>(open_.back())];
    const absl::string_view word = cursor_.Word();
    int count = 0;
    if (!base::ParseInteger(word, &count) || count < 0 || count > kMaxChannels) {
      return Unexpected(word, "a number of channels, 0 to 6");
    }
    if (!joint.channels.empty()) return Error("CHANNELS: expected once per joint, got twice");
    for (int i = 0; i < count; ++i) {
      const absl::string_view name = cursor_.Word();
      const std::optional<BvhChannel> channel = FindChannel(name);
      if (!channel) return Unexpected(name, "a channel such as Xposition or Zrotation");
      if (std::count(joint.channels.begin(), joint.channels.end(), *channel) > 0) {
        return Error(absl::StrCat("channel ", name, ": expected once per joint, got twice"));
      }
      joint.channels.push_back(*channel);
    }
    return absl::OkStatus();
  }

  absl::Status ParseMotionHeader() {
    absl::string_view word = cursor_.Word();
    if (word != "Frames:") return Unexpected(word, "Frames:");
    word = cursor_.Word();
    if (!base::ParseInteger(word, &document_.frame_count) || document_.frame_count < 1 ||
        document_.frame_count > motion::kMaxMotionFrames) {
      return Unexpected(word, absl::StrCat("a number of frames, 1 to ", motion::kMaxMotionFrames));
    }
    word = cursor_.Word();
    if (word == "Frame") word = cursor_.Word();
    if (word != "Time:") return Unexpected(word, "Frame Time:");
    word = cursor_.Word();
    if (!base::ParseNumber(word, &document_.frame_time_s) ||
        !(document_.frame_time_s >= 1 / motion::kMaxFrameRateHz && document_.frame_time_s <= 10)) {
      return Unexpected(word, "a frame time of 0.001 to 10 seconds");
    }
    document_.frame_time_decimals = DecimalsOf(word);
    return absl::OkStatus();
  }

  absl::Status ParseFrames() {
    const int first_line = cursor_.line();
    base::LineReader lines(cursor_.rest());
    int frames = 0;
    for (absl::string_view line; lines.Next(&line);) {
      line = absl::StripAsciiWhitespace(line);
      if (line.empty()) continue;
      const int number = first_line + lines.number() - 1;
      // Some programs count from 0, or do not count the rest pose.
      if (frames > document_.frame_count) {
        return base::ErrorAt(source_, number,
                             absl::StrCat("expected the ", document_.frame_count,
                                          " frames of Frames:, got at least 2 more"));
      }
      absl::Status status = ParseFrame(line, number);
      if (!status.ok()) return status;
      ++frames;
    }
    if (frames == document_.frame_count) return absl::OkStatus();
    if (frames == 0 || frames < document_.frame_count - 1 || frames > motion::kMaxMotionFrames) {
      return base::ErrorAt(
          source_, first_line + lines.number(),
          absl::StrCat("expected the ", document_.frame_count, " frames of Frames:, got ", frames,
                       "; if the file is whole, correct the number"));
    }
    document_.stated_frame_count = std::exchange(document_.frame_count, frames);
    return absl::OkStatus();
  }

  absl::Status ParseFrame(absl::string_view line, int number) {
    const int expected = document_.ChannelCount();
    Cursor words(line);
    int count = 0;
    for (absl::string_view word = words.Word(); !word.empty(); word = words.Word(), ++count) {
      float value = 0;
      if (!motion::ParseCoordinate(word, &value)) {
        return base::ErrorAt(
            source_, number,
            absl::StrCat("channel value ", count + 1, ": ", motion::ExpectedCoordinate(word)));
      }
      if (count < expected) document_.values.push_back(value);
    }
    if (count == expected) return absl::OkStatus();
    return base::ErrorAt(source_, number,
                         absl::StrCat("expected ", expected, " channel values, got ", count));
  }

  Cursor cursor_;
  absl::string_view source_;
  BvhDocument document_;
  std::vector<int> open_;         // joints whose brace is open, outermost first
  std::vector<bool> has_offset_;  // [joints]
};

class BvhFormatter {
 public:
  explicit BvhFormatter(const BvhDocument& document) : document_(document) {}

  std::string Format() {
    out_ = "HIERARCHY\n";
    std::vector<int> open;
    for (std::size_t joint = 0; joint < document_.joints.size(); ++joint) {
      const int parent = document_.joints[joint].parent;
      while (!open.empty() && open.back() != parent) Close(&open);
      Open(document_.joints[joint], open.size());
      open.push_back(static_cast<int>(joint));
    }
    while (!open.empty()) Close(&open);
    AppendMotion();
    return std::move(out_);
  }

 private:
  void Indent(std::size_t depth) { out_.append(2 * depth, ' '); }

  void Open(const BvhJoint& joint, std::size_t depth) {
    Indent(depth);
    if (joint.end_site) {
      out_ += "End Site\n";
    } else {
      absl::StrAppend(&out_, joint.parent < 0 ? "ROOT " : "JOINT ", joint.name, "\n");
    }
    Indent(depth);
    out_ += "{\n";
    Indent(depth + 1);
    out_ += "OFFSET";
    for (double value : {joint.offset.x, joint.offset.y, joint.offset.z}) {
      out_ += ' ';
      base::AppendFixed(&out_, value, kOffsetDecimals);
    }
    out_ += '\n';
    if (!joint.end_site) AppendChannels(joint, depth + 1);
  }

  void Close(std::vector<int>* open) {
    open->pop_back();
    Indent(open->size());
    out_ += "}\n";
  }

  void AppendChannels(const BvhJoint& joint, std::size_t depth) {
    Indent(depth);
    absl::StrAppend(&out_, "CHANNELS ", joint.channels.size());
    for (BvhChannel channel : joint.channels) {
      absl::StrAppend(&out_, " ", kChannelNames[static_cast<std::size_t>(channel)]);
    }
    out_ += '\n';
  }

  void AppendMotion() {
    absl::StrAppend(&out_, "MOTION\nFrames: ", document_.frame_count, "\nFrame Time: ");
    base::AppendFixed(&out_, document_.frame_time_s, kFrameTimeDecimals);
    out_ += '\n';
    const std::size_t channels = static_cast<std::size_t>(document_.ChannelCount());
    for (std::size_t i = 0; i < document_.values.size(); ++i) {
      base::AppendFixed(&out_, static_cast<double>(document_.values[i]), kValueDecimals);
      out_ += (i + 1) % channels == 0 ? '\n' : ' ';
    }
  }

  const BvhDocument& document_;
  std::string out_;
};

}  // namespace

double RateOfFrameTime(double seconds, std::optional<int> decimals) {
  const double rate = 1 / seconds, whole = std::round(rate);
  const auto is_whole = [&](double tolerance) {
    return whole >= 1 && std::abs(rate - whole) < tolerance * whole;
  };
  if (is_whole(kExact)) return whole;
  const int digits = decimals.value_or(kManyDecimals);
  if (const double common = NearestCommon(seconds, digits); common > 0) return common;
  if (is_whole(kRateTolerance)) return whole;
  return rate;
}

int BvhDocument::ChannelCount() const {
  std::size_t count = 0;
  for (const BvhJoint& joint : joints) count += joint.channels.size();
  return static_cast<int>(count);
}

absl::StatusOr<BvhDocument> ParseBvh(absl::string_view text, absl::string_view source) {
  return BvhParser(text, source).Parse();
}

std::string FormatBvh(const BvhDocument& document) { return BvhFormatter(document).Format(); }

BvhPose PoseAt(const BvhDocument& document, int frame) {
  const std::size_t count = document.joints.size();
  BvhPose pose{std::vector<retargeting::Vec3d>(count), std::vector<retargeting::Quaternion>(count)};
  const float* value =
      document.values.data() +
      static_cast<std::size_t>(frame) * static_cast<std::size_t>(document.ChannelCount());
  for (std::size_t j = 0; j < count; ++j) {
    const BvhJoint& joint = document.joints[j];
    retargeting::Vec3d translation = joint.offset;
    retargeting::Quaternion rotation;
    for (BvhChannel channel : joint.channels) {
      const double by = static_cast<double>(*value++);
      const int axis = AxisOf(channel);
      if (IsRotation(channel)) {
        rotation = rotation * retargeting::AxisAngle(retargeting::UnitAxis(axis),
                                                     by * base::kRadiansPerDegree);
      } else {
        Component(translation, axis) = by;
      }
    }
    if (joint.parent < 0) {
      pose.positions[j] = translation;
      pose.rotations[j] = rotation;
      continue;
    }
    const std::size_t parent = static_cast<std::size_t>(joint.parent);
    pose.positions[j] = pose.positions[parent] + Rotate(pose.rotations[parent], translation);
    pose.rotations[j] = pose.rotations[parent] * rotation;
  }
  return pose;
}

}  // namespace duet::formats::bvh
