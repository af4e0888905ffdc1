#include "model/formats/flat/json_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"
#include "nlohmann/json.hpp"

namespace duet::formats::flat {
namespace {

using Json = nlohmann::json;

constexpr char kFormat[] = "duet-motion";
constexpr int kVersion = 1;
// Of our documents: object, people, frames, positions. Deeper ones would only cost memory.
constexpr int kMaxDepth = 8;
constexpr const char* kPeople[] = {"leader", "follower"};

class JsonReader {
 public:
  JsonReader(const Json& document, absl::string_view source)
      : document_(document), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Read() {
    if (!document_.is_object()) return Error("came no JSON object, wanted {...}");
    absl::Status status = ReadSettings();
    if (status.ok()) status = ReadJointNames();
    if (!status.ok()) return status;
    for (const char* person : kPeople) {
      if (person != kPeople[0] && !document_.contains(person)) continue;
      motion_.people.push_back(empty_);
      status = ReadPerson(person, &motion_.people.back());
      if (!status.ok()) return status;
    }
    return std::move(motion_);
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return absl::InvalidArgumentError(absl::StrCat(source_, ": ", message));
  }

  absl::Status Unexpected(absl::string_view field, const Json& came,
                          absl::string_view wanted) const {
    // A replacement for bytes that are no UTF-8: a message must not fail.
    const std::string text = came.is_structured()
                                 ? absl::StrCat("an ", came.type_name())
                                 : came.dump(-1, ' ', false, Json::error_handler_t::replace);
    return Error(absl::StrCat(field, ": came ", base::Quoted(text), ", wanted ", wanted));
  }

  absl::Status ReadSettings() {
    if (const auto format = document_.find("format");
        format != document_.end() && *format != kFormat) {
      return Unexpected("format", *format, kFormat);
    }
    if (const auto version = document_.find("version");
        version != document_.end() && *version != kVersion) {
      return Unexpected("version", *version, "1");
    }
    if (const auto rate = document_.find("frame_rate_hz"); rate != document_.end()) {
      if (!rate->is_number() || !base::CheckFrameRate("", rate->get<double>()).ok()) {
        return Unexpected("frame_rate_hz", *rate,
                          absl::StrCat("a number above 0 and at most ", base::kMaxFrameRateHz));
      }
      empty_.frame_rate_hz = rate->get<double>();
    }
    return ReadCoordinates();
  }

  absl::Status ReadCoordinates() {
    if (const auto unit = document_.find("unit"); unit != document_.end()) {
      if (*unit != "metres" && *unit != "millimetres") {
        return Unexpected("unit", *unit, "metres or millimetres");
      }
      motion_.coordinates.unit =
          *unit == "metres" ? motion::LengthUnit::kMetres : motion::LengthUnit::kMillimetres;
    }
    if (const auto up = document_.find("up_axis"); up != document_.end()) {
      if (*up != "y" && *up != "z" && *up != "-y") return Unexpected("up_axis", *up, "y, z or -y");
      motion_.coordinates.up_axis = *up == "y"   ? motion::UpAxis::kYUp
                                    : *up == "z" ? motion::UpAxis::kZUp
                                                 : motion::UpAxis::kYDown;
    }
    return absl::OkStatus();
  }

  absl::Status ReadJointNames() {
    const auto names = document_.find("joint_names");
    if (names == document_.end()) return Error("joint_names: missing, wanted a list of names");
    if (!names->is_array() || names->empty() || names->size() > base::kMaxFileJoints) {
      return Unexpected("joint_names", *names,
                        absl::StrCat("1 to ", base::kMaxFileJoints, " names"));
    }
    for (const Json& name : *names) {
      if (!name.is_string()) return Unexpected("joint_names", name, "a name");
      empty_.joint_names.push_back(name.get<std::string>());
    }
    return absl::OkStatus();
  }

  absl::Status ReadPerson(const char* field, motion::Clip* clip) const {
    const auto frames = document_.find(field);
    if (frames == document_.end()) return Error(absl::StrCat(field, ": missing, wanted frames"));
    if (!frames->is_array() || frames->empty() || frames->size() > base::kMaxMotionFrames) {
      return Unexpected(field, *frames, absl::StrCat("1 to ", base::kMaxMotionFrames, " frames"));
    }
    for (std::size_t frame = 0; frame < frames->size(); ++frame) {
      absl::Status status = ReadFrame(absl::StrCat(field, "[", frame, "]"), (*frames)[frame], clip);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status ReadFrame(const std::string& field, const Json& frame, motion::Clip* clip) const {
    const std::size_t joints = clip->joint_names.size();
    if (!frame.is_array() || frame.size() != joints) {
      return Unexpected(field, frame, absl::StrCat("a list of ", joints, " positions"));
    }
    for (std::size_t joint = 0; joint < joints; ++joint) {
      motion::Vec3 position;
      if (!ReadPosition(frame[joint], &position)) {
        return Unexpected(absl::StrCat(field, "[", joint, "]"), frame[joint],
                          "[x, y, z], finite numbers");
      }
      clip->positions.push_back(position);
    }
    return absl::OkStatus();
  }

  static bool ReadPosition(const Json& value, motion::Vec3* position) {
    if (!value.is_array() || value.size() != 3) return false;
    float* const axes[] = {&position->x, &position->y, &position->z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!value[axis].is_number()) return false;
      const double number = value[axis].get<double>();
      if (!(std::abs(number) <= base::kMaxCoordinate)) return false;
      *axes[axis] = static_cast<float>(number);
    }
    return true;
  }

  const Json& document_;
  absl::string_view source_;
  motion::Clip empty_;
  motion::RecordedMotion motion_;
};

// The deepest nesting of brackets outside strings.
int NestingDepth(absl::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string && (c == '[' || c == '{')) {
      deepest = std::max(deepest, ++depth);
    } else if (!in_string && (c == ']' || c == '}')) {
      --depth;
    }
  }
  return deepest;
}

void AppendPerson(const char* field, const motion::Clip& clip, std::string* out) {
  absl::StrAppend(out, ",\n\"", field, "\": [");
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    *out += frame == 0 ? "\n[" : ",\n[";
    for (int joint = 0; joint < clip.joint_count(); ++joint) {
      const motion::Vec3 position = clip.at(frame, joint);
      char before = '[';
      if (joint > 0) *out += ", ";
      for (float value : {position.x, position.y, position.z}) {
        *out += before;
        base::AppendNumber(out, value);
        before = ',';
      }
      *out += ']';
    }
    *out += ']';
  }
  *out += "]";
}

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseJsonMotion(absl::string_view text,
                                                       absl::string_view source) {
  if (const int depth = NestingDepth(text); depth > kMaxDepth) {
    return absl::InvalidArgumentError(
        absl::StrCat(source, ": brackets ", depth, " deep, wanted at most ", kMaxDepth));
  }
  const Json document = Json::parse(text.begin(), text.end(), nullptr, /*allow_exceptions=*/false);
  if (document.is_discarded()) {
    return absl::InvalidArgumentError(absl::StrCat(source, ": no valid JSON document"));
  }
  return JsonReader(document, source).Read();
}

std::string FormatJsonMotion(const motion::ClipPair& pair, const motion::Skeleton& skeleton) {
  Json bones = Json::array();
  for (const motion::Bone& bone : skeleton.bones) bones.push_back({bone.parent, bone.child});
  std::string text = absl::StrCat("{\"format\": \"", kFormat, "\", \"version\": ", kVersion,
                                  ", \"frame_rate_hz\": ");
  base::AppendNumber(&text, pair.leader.frame_rate_hz);
  absl::StrAppend(&text, ", \"unit\": \"metres\", \"up_axis\": \"y\",\n\"joint_names\": ",
                  Json(pair.leader.joint_names).dump(), ",\n\"bones\": ", bones.dump());
  AppendPerson(kPeople[0], pair.leader, &text);
  AppendPerson(kPeople[1], pair.follower, &text);
  text += "}\n";
  return text;
}

}  // namespace duet::formats::flat
