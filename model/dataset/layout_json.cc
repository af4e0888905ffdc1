#include <initializer_list>
#include <map>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/dataset/layout.h"
#include "model/motion/skeleton_json.h"
#include "nlohmann/json.hpp"

namespace duet::dataset {
namespace {

using Json = nlohmann::json;

constexpr double kMinFrameRateHz = 1;
constexpr double kMaxFrameRateHz = 240;
constexpr int kMaxJoints = 256;
constexpr int kMaxClasses = 256;

absl::Status Wrong(const std::string& field, const std::string& came, const std::string& wanted) {
  return absl::InvalidArgumentError(
      absl::StrCat("dataset.json: ", field, ": ", came, ", wanted ", wanted));
}

// Repeated keys would silently win over one another: the parser refuses them.
Json ParseWithoutRepeats(std::string_view text, std::string* repeated) {
  std::vector<std::set<std::string>> keys;
  const auto callback = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key) {
      const std::string key = parsed.get<std::string>();
      if (!keys.back().insert(key).second) *repeated = key;
    }
    return true;
  };
  return Json::parse(text.begin(), text.end(), callback, /*allow_exceptions=*/false);
}

// Every key known, every required key there.
absl::Status CheckKeys(const std::string& field, const Json& object,
                       std::initializer_list<const char*> required,
                       std::initializer_list<const char*> optional) {
  const std::string where = field.empty() ? "the document" : field;
  if (!object.is_object()) return Wrong(where, object.type_name(), "an object");
  std::set<std::string> known(required.begin(), required.end());
  known.insert(optional.begin(), optional.end());
  for (const auto& item : object.items()) {
    if (known.count(item.key()) == 0) {
      return Wrong(where, absl::StrCat("unknown field \"", item.key(), "\""),
                   absl::StrJoin(known, ", "));
    }
  }
  for (const char* key : required) {
    if (!object.contains(key)) return Wrong(where, "nothing", absl::StrCat("the field ", key));
  }
  return absl::OkStatus();
}

absl::Status ReadName(const std::string& field, const Json& value, std::string* out) {
  if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
    return Wrong(field, value.dump(), "a name");
  }
  *out = value.get<std::string>();
  return absl::OkStatus();
}

absl::Status ReadJoint(const std::string& field, const Json& value,
                       const motion::Skeleton& skeleton, int* out) {
  std::string name;
  absl::Status status = ReadName(field, value, &name);
  if (!status.ok()) return status;
  *out = skeleton.Find(name);
  if (*out >= 0) return absl::OkStatus();
  return Wrong(field, absl::StrCat("\"", name, "\""), "one of skeleton.joint_names");
}

absl::Status ReadJoints(const std::string& field, const Json& value,
                        const motion::Skeleton& skeleton, std::vector<int>* out) {
  if (!value.is_array() || value.empty() || value.size() > kMaxJoints) {
    return Wrong(field, value.dump(), absl::StrCat("a list of 1 to ", kMaxJoints, " joints"));
  }
  for (size_t i = 0; i < value.size(); ++i) {
    int joint = 0;
    absl::Status status = ReadJoint(absl::StrCat(field, "[", i, "]"), value[i], skeleton, &joint);
    if (!status.ok()) return status;
    out->push_back(joint);
  }
  return absl::OkStatus();
}

absl::Status ReadSkeleton(const Json& json, DatasetLayout* layout) {
  absl::StatusOr<motion::SkeletonDocument> document = motion::ReadSkeleton(json, "skeleton");
  if (!document.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("dataset.json: ", document.status().message()));
  }
  layout->skeleton = std::move(document->skeleton);
  layout->parts = std::move(document->parts);
  return absl::OkStatus();
}

// A class's folder bears the class's name: it may not lead anywhere else.
bool IsPlainFolderName(const std::string& name) {
  return name.find_first_of("/\\") == std::string::npos && name[0] != '.';
}

absl::Status ReadClass(const std::string& field, const Json& json, const motion::Skeleton& skeleton,
                       ClassLayout* out) {
  absl::Status status = CheckKeys(field, json, {"name"}, {"symmetric", "effectors"});
  if (status.ok()) status = ReadName(field + ".name", json["name"], &out->name);
  if (!status.ok()) return status;
  if (!IsPlainFolderName(out->name)) {
    return Wrong(field + ".name", json["name"].dump(), "a plain folder name");
  }
  out->folder = out->name;
  if (json.contains("symmetric")) {
    if (!json["symmetric"].is_boolean()) {
      return Wrong(field + ".symmetric", json["symmetric"].dump(), "true or false");
    }
    out->symmetric = json["symmetric"].get<bool>();
  }
  if (!json.contains("effectors")) return absl::OkStatus();
  return ReadJoints(field + ".effectors", json["effectors"], skeleton, &out->effectors);
}

absl::Status ReadClasses(const Json& json, DatasetLayout* layout) {
  if (!json.is_array() || json.empty() || json.size() > kMaxClasses) {
    return Wrong("classes",
                 json.is_array() ? absl::StrCat(json.size(), " entries") : json.type_name(),
                 absl::StrCat("a list of 1 to ", kMaxClasses));
  }
  std::set<std::string> seen;
  for (size_t i = 0; i < json.size(); ++i) {
    const std::string field = absl::StrCat("classes[", i, "]");
    ClassLayout one;
    absl::Status status = ReadClass(field, json[i], layout->skeleton, &one);
    if (!status.ok()) return status;
    if (!seen.insert(one.name).second) {
      return Wrong(field + ".name", absl::StrCat("\"", one.name, "\" again"), "a new name");
    }
    layout->classes.push_back(std::move(one));
  }
  return absl::OkStatus();
}

template <typename T>
absl::Status ReadChoice(const std::string& field, const Json& value,
                        const std::map<std::string, T>& choices, T* out) {
  const auto found =
      value.is_string() ? choices.find(value.get_ref<const std::string&>()) : choices.end();
  if (found == choices.end()) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    return Wrong(field, value.dump(), absl::StrJoin(names, ", "));
  }
  *out = found->second;
  return absl::OkStatus();
}

absl::Status ReadCoordinates(const Json& json, motion::CoordinateFrame* frame) {
  absl::Status status =
      ReadChoice<motion::LengthUnit>("unit", json["unit"],
                                     {{"metres", motion::LengthUnit::kMetres},
                                      {"millimetres", motion::LengthUnit::kMillimetres},
                                      {"sbu_normalised", motion::LengthUnit::kSbuNormalised}},
                                     &frame->unit);
  if (!status.ok()) return status;
  status = ReadChoice<motion::UpAxis>("up_axis", json["up_axis"],
                                      {{"y_up", motion::UpAxis::kYUp},
                                       {"z_up", motion::UpAxis::kZUp},
                                       {"y_down", motion::UpAxis::kYDown}},
                                      &frame->up_axis);
  if (!status.ok()) return status;
  if (frame->unit == motion::LengthUnit::kSbuNormalised &&
      frame->up_axis != motion::UpAxis::kYDown) {
    return Wrong("up_axis", json["up_axis"].dump(), "y_down, which sbu_normalised implies");
  }
  return absl::OkStatus();
}

absl::Status ReadFrameRate(const Json& value, double* out) {
  if (value.is_number()) *out = value.get<double>();
  if (*out >= kMinFrameRateHz && *out <= kMaxFrameRateHz) return absl::OkStatus();
  return Wrong("frame_rate_hz", value.dump(),
               absl::StrCat(kMinFrameRateHz, " to ", kMaxFrameRateHz));
}

}  // namespace

absl::StatusOr<DatasetLayout> ParseDatasetLayout(std::string_view text) {
  std::string repeated;
  const Json json = ParseWithoutRepeats(text, &repeated);
  if (json.is_discarded()) return absl::InvalidArgumentError("dataset.json: not valid JSON");
  if (!repeated.empty()) return Wrong(repeated, "given twice", "each field once");
  DatasetLayout layout;
  absl::Status status =
      CheckKeys("", json, {"name", "frame_rate_hz", "unit", "up_axis", "skeleton", "classes"}, {});
  if (status.ok()) status = ReadName("name", json["name"], &layout.name);
  if (status.ok()) status = ReadFrameRate(json["frame_rate_hz"], &layout.frame_rate_hz);
  if (status.ok()) status = ReadCoordinates(json, &layout.frame);
  if (status.ok()) status = ReadSkeleton(json["skeleton"], &layout);
  if (status.ok()) status = ReadClasses(json["classes"], &layout);
  if (!status.ok()) return status;
  return layout;
}

}  // namespace duet::dataset
