#include "model/motion/skeleton_json.h"

#include <cstddef>
#include <optional>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::motion {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Far above any character. Limits the size of the network that a small file can request.
constexpr std::size_t kMaxJoints = 256;
constexpr std::size_t kMaxParts = 64;
constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kMaxTextBytes = 4096;
constexpr char kWholeBody[] = "whole_body";  // reserved for the slice that the generator adds

// Whether `name` may be part of a tensor's name.
bool IsPlainName(const std::string& name) {
  if (name.empty() || name.size() > kMaxNameBytes || name.front() == '.') return false;
  for (const char c : name) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-') {
      return false;
    }
  }
  return true;
}

int ReadJoint(base::ObjectReader* reader, const std::string& key, const Skeleton& skeleton) {
  const std::string name = reader->String(key, kMaxTextBytes);
  return reader->ok() ? FindJoint(reader, key, skeleton, name) : 0;
}

std::vector<Bone> ReadBones(base::ObjectReader* reader, const Skeleton& skeleton) {
  std::vector<Bone> bones;
  for (const json& item : reader->Array("bones", kMaxJoints)) {
    const std::string key = absl::StrCat("bones[", bones.size(), "]");
    const bool is_pair =
        item.is_array() && item.size() == 2 && item[0].is_string() && item[1].is_string();
    if (!is_pair) {
      reader->Fail(key, absl::StrCat("expected a pair of joint names, parent first, got ",
                                     base::Shown(item)));
      return {};
    }
    bones.push_back({FindJoint(reader, key, skeleton, item[0].get<std::string>()),
                     FindJoint(reader, key, skeleton, item[1].get<std::string>())});
  }
  return bones;
}

BodyPart ReadPart(base::ObjectReader* fields, const Skeleton& skeleton,
                  std::set<std::string>* seen) {
  BodyPart part;
  part.name = fields->String("name", kMaxTextBytes);
  if (fields->ok() && !IsPlainName(part.name)) {
    fields->Fail("name", absl::StrCat("expected 1 to ", kMaxNameBytes,
                                      " letters, digits, '_', '-' or '.', the first of them not "
                                      "'.', got ",
                                      base::Quoted(part.name)));
  }
  for (const std::string& joint : fields->UniqueStrings("joints", kMaxJoints, kMaxNameBytes)) {
    part.joints.push_back(FindJoint(fields, "joints", skeleton, joint));
  }
  if (!seen->insert(part.name).second) {
    fields->Fail("name", absl::StrCat(base::Quoted(part.name), " is repeated or reserved"));
  }
  return part;
}

std::vector<BodyPart> ReadParts(base::ObjectReader* reader, const Skeleton& skeleton) {
  std::vector<BodyPart> parts;
  std::set<std::string> seen = {kWholeBody};
  for (const json& item : reader->Array("parts", kMaxParts)) {
    base::ObjectReader fields(item, reader->PathOf(absl::StrCat("parts[", parts.size(), "]")));
    parts.push_back(ReadPart(&fields, skeleton, &seen));
    reader->Update(fields.Finish());
  }
  return parts;
}

std::optional<JointPair> ReadPair(base::ObjectReader* reader, const std::string& left,
                                  const std::string& right, const Skeleton& skeleton) {
  if (!reader->Has(left) && !reader->Has(right)) return std::nullopt;
  const int left_joint = ReadJoint(reader, left, skeleton);
  return JointPair{left_joint, ReadJoint(reader, right, skeleton)};
}

}  // namespace

int FindJoint(base::ObjectReader* reader, const std::string& key, const Skeleton& skeleton,
              const std::string& name) {
  const int joint = skeleton.Find(name);
  if (joint < 0) {
    reader->Fail(key,
                 absl::StrCat("expected one of skeleton.joint_names, got ", base::Quoted(name)));
  }
  return joint;
}

absl::StatusOr<SkeletonDocument> ReadSkeleton(const json& value, const std::string& path) {
  base::ObjectReader reader(value, path);
  SkeletonDocument document;
  Skeleton& skeleton = document.skeleton;
  skeleton.joint_names = reader.UniqueStrings("joint_names", kMaxJoints, kMaxNameBytes);
  skeleton.bones = ReadBones(&reader, skeleton);
  document.parts = ReadParts(&reader, skeleton);
  skeleton.root = ReadJoint(&reader, "root", skeleton);
  skeleton.hips = ReadPair(&reader, "left_hip", "right_hip", skeleton);
  skeleton.feet = ReadPair(&reader, "left_foot", "right_foot", skeleton);
  if (absl::Status status = reader.Finish(); !status.ok()) return status;
  absl::Status status = Validate(skeleton);
  if (status.ok()) status = Validate(document.parts, skeleton);
  if (status.ok()) return document;
  return absl::InvalidArgumentError(absl::StrCat(path, ".", status.message()));
}

ordered_json SkeletonToJson(const Skeleton& skeleton, const std::vector<BodyPart>& parts) {
  const auto name = [&](int joint) {
    return skeleton.joint_names[static_cast<std::size_t>(joint)];
  };
  ordered_json bones = ordered_json::array();
  for (const Bone& bone : skeleton.bones) {
    bones.push_back(ordered_json::array({name(bone.parent), name(bone.child)}));
  }
  ordered_json part_list = ordered_json::array();
  for (const BodyPart& part : parts) {
    ordered_json joints = ordered_json::array();
    for (const int joint : part.joints) joints.push_back(name(joint));
    part_list.push_back({{"name", part.name}, {"joints", joints}});
  }
  ordered_json object = {{"joint_names", skeleton.joint_names},
                         {"bones", bones},
                         {"parts", part_list},
                         {"root", name(skeleton.root)}};
  if (skeleton.hips) {
    object["left_hip"] = name(skeleton.hips->left);
    object["right_hip"] = name(skeleton.hips->right);
  }
  if (skeleton.feet) {
    object["left_foot"] = name(skeleton.feet->left);
    object["right_foot"] = name(skeleton.feet->right);
  }
  return object;
}

}  // namespace duet::motion
