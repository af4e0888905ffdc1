#include "model/dataset/layout.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"
#include "model/motion/sbu.h"

namespace duet::dataset {
namespace {

using Json = nlohmann::json;

constexpr double kMinFrameRateHz = 1;
constexpr int kMaxDepth = 6;
constexpr std::size_t kMaxJoints = 256;
constexpr std::size_t kMaxClasses = 256;
constexpr std::size_t kMaxNameBytes = 256;

std::string ReadName(base::ObjectReader* reader, const std::string& key) {
  std::string name = reader->String(key, kMaxNameBytes);
  if (reader->ok() && name.empty()) reader->Fail(key, "expected a name, got \"\"");
  return name;
}

std::vector<int> ReadJoints(base::ObjectReader* reader, const std::string& key,
                            const motion::Skeleton& skeleton) {
  std::vector<int> joints;
  for (const std::string& name : reader->Strings(key, kMaxJoints)) {
    joints.push_back(
        motion::FindJoint(reader, absl::StrCat(key, "[", joints.size(), "]"), skeleton, name));
  }
  if (joints.empty()) reader->Fail(key, "expected at least one joint, got none");
  return joints;
}

void ReadSkeleton(base::ObjectReader* document, DatasetLayout* layout) {
  const Json& written = document->Object("skeleton");
  if (!document->ok()) return;
  absl::StatusOr<motion::SkeletonDocument> read = ReadWrittenSkeleton(written, &layout->notes);
  document->Update(read.status());
  if (!read.ok()) return;
  layout->skeleton = std::move(read->skeleton);
  layout->parts = std::move(read->parts);
}

// Whether `name` is a plain folder name: the folder of a class has the class's name.
bool IsPlainFolderName(const std::string& name) {
  return !name.empty() && name.find_first_of("/\\") == std::string::npos && name[0] != '.';
}

ClassLayout ReadClass(base::ObjectReader* reader, const motion::Skeleton& skeleton) {
  ClassLayout one;
  one.name = ReadName(reader, "name");
  if (reader->ok() && !IsPlainFolderName(one.name)) {
    reader->Fail("name",
                 absl::StrCat("expected a plain folder name, got ", base::Quoted(one.name)));
  }
  one.folder = one.name;
  if (reader->Has("symmetric")) one.symmetric = reader->Bool("symmetric");
  if (reader->Has("handed")) one.handed = reader->Bool("handed");
  if (reader->Has("touches")) one.touches = reader->Bool("touches");
  if (reader->Has("effectors")) one.effectors = ReadJoints(reader, "effectors", skeleton);
  return one;
}

std::vector<ClassLayout> ReadClasses(base::ObjectReader* document,
                                     const motion::Skeleton& skeleton) {
  std::vector<ClassLayout> classes;
  std::set<std::string> seen;
  for (const Json& item : document->Array("classes", kMaxClasses)) {
    base::ObjectReader reader(item, absl::StrCat("classes[", classes.size(), "]"));
    ClassLayout one = ReadClass(&reader, skeleton);
    if (!seen.insert(one.name).second) {
      reader.Fail("name",
                  absl::StrCat("expected a new name, got ", base::Quoted(one.name), " again"));
    }
    document->Update(reader.Finish());
    classes.push_back(std::move(one));
  }
  if (classes.empty()) document->Fail("classes", "expected at least one, got none");
  return classes;
}

motion::Coordinates ReadCoordinates(base::ObjectReader* document) {
  motion::Coordinates coordinates;
  coordinates.unit = document->Choice("unit", motion::ParseLengthUnit, motion::kLengthUnitNames);
  coordinates.up_axis = document->Choice("up_axis", motion::ParseUpAxis, motion::kUpAxisNames);
  if (document->ok() && coordinates.unit == motion::LengthUnit::kSbuNormalised &&
      coordinates.up_axis != motion::UpAxis::kYDown) {
    document->Fail("up_axis", absl::StrCat("expected y-down, which sbu-normalised implies, got ",
                                           UpAxisName(coordinates.up_axis)));
  }
  return coordinates;
}

std::optional<motion::Vec3> ReadPeopleAxis(base::ObjectReader* document) {
  if (!document->Has("people_axis")) return std::nullopt;
  const std::string axis = document->String("people_axis", kMaxNameBytes);
  if (axis == "x") return motion::Vec3{1, 0, 0};
  if (axis == "z") return motion::Vec3{0, 0, 1};
  if (document->ok()) {
    document->Fail("people_axis", absl::StrCat("expected x or z, got ", base::Quoted(axis)));
  }
  return std::nullopt;
}

bool ReadLevel(base::ObjectReader* document, const motion::Skeleton& skeleton) {
  if (!document->Has("level")) return false;
  const bool level = document->Bool("level");
  if (document->ok() && level && !skeleton.feet) {
    document->Fail("level", "expected skeleton.left_foot and right_foot for true, got none");
  }
  return level;
}

constexpr double kK3hiFrameRateHz = 30;

// Both data sets share skeleton and units.
DatasetLayout KinectLayout(const std::string& name, double frame_rate_hz,
                           std::vector<ClassLayout> classes) {
  DatasetLayout layout;
  layout.name = name;
  layout.frame_rate_hz = frame_rate_hz;
  layout.coordinates = {motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown};
  layout.skeleton = motion::SbuSkeleton();
  layout.parts = motion::SbuParts();
  layout.people_axis = motion::Vec3{1, 0, 0};  // the image's x axis
  layout.level = true;
  const std::vector<int> feet = {layout.skeleton.feet->left, layout.skeleton.feet->right};
  const std::vector<int> hands = {layout.skeleton.Find("left_hand"),
                                  layout.skeleton.Find("right_hand")};
  for (ClassLayout& one : classes) one.effectors = one.name == "kick" ? feet : hands;
  layout.classes = std::move(classes);
  return layout;
}

}  // namespace

DatasetLayout SbuLayout() {
  return KinectLayout("sbu", motion::kSbuFrameRateHz,
                      {{"kick", "03", false, false, false, {}},
                       {"push", "04", false, false, false, {}},
                       {"shake_hands", "05", true, true, false, {}},
                       {"hug", "06", true, false, true, {}},
                       {"exchange_object", "07", true, true, false, {}},
                       {"punch", "08", false, false, false, {}}});
}

bool IsSbuSet(std::string_view name) {
  const auto digit = [&](size_t i) { return name[i] >= '0' && name[i] <= '9'; };
  return name.size() == 6 && name[0] == 's' && name[3] == 's' && digit(1) && digit(2) && digit(4) &&
         digit(5);
}

DatasetLayout K3hiLayout() {
  return KinectLayout("k3hi", kK3hiFrameRateHz,
                      {{"approach", "approaching", false, false, false, {}},
                       {"depart", "departing", false, false, false, {}},
                       {"exchange_object", "exchanging", true, true, false, {}},
                       {"kick", "kicking", false, false, false, {}},
                       {"point", "pointing", false, true, false, {}},
                       {"punch", "punching", false, false, false, {}},
                       {"push", "pushing", false, false, false, {}},
                       {"shake_hands", "shaking", true, true, false, {}}});
}

absl::StatusOr<DatasetLayout> ParseDatasetLayout(std::string_view text) {
  const auto in_file = [](const absl::Status& status) {
    return absl::InvalidArgumentError(absl::StrCat("dataset.json: ", status.message()));
  };
  const absl::StatusOr<Json> json =
      base::ParseHandwrittenJson({text.data(), text.size()}, kMaxDepth);
  if (!json.ok()) return in_file(json.status());
  base::ObjectReader document(*json, "");
  DatasetLayout layout;
  layout.name = ReadName(&document, "name");
  layout.frame_rate_hz =
      document.Number("frame_rate_hz", kMinFrameRateHz, motion::kMaxServedFrameRateHz);
  layout.coordinates = ReadCoordinates(&document);
  ReadSkeleton(&document, &layout);
  layout.level = ReadLevel(&document, layout.skeleton);
  layout.people_axis = ReadPeopleAxis(&document);
  layout.classes = ReadClasses(&document, layout.skeleton);
  if (const absl::Status status = document.Finish(); !status.ok()) return in_file(status);
  return layout;
}

bool DescribesBatch(std::string_view text) {
  const absl::StatusOr<Json> json =
      base::ParseHandwrittenJson({text.data(), text.size()}, kMaxDepth);
  return json.ok() && json->value("format", Json()) == "duet-batch";
}

}  // namespace duet::dataset
