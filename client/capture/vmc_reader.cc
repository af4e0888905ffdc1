#include "client/capture/vmc_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/index.h"
#include "model/base/text.h"

namespace duet::client::capture {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr char kBone[] = "/VMC/Ext/Bone/Pos", kRoot[] = "/VMC/Ext/Root/Pos", kTime[] = "/VMC/Ext/T";
constexpr std::size_t kTransformArguments = 8;  // a name, a position and a quaternion
constexpr double kNoOffset = 1e-6;              // metres
// After this many frames, bones that have not come are reported.
constexpr int kNotesAfterFrames = 30;
constexpr std::size_t kMostRemembered = 6;

using base::Index;

// Between Unity's axes and right-handed ones; its own inverse.
Vec3d Mirrored(Vec3d a) { return {-a.x, a.y, a.z}; }

// Keeps a few different names, for a message.
void Remember(absl::string_view name, std::set<std::string>* names) {
  if (names->size() < kMostRemembered) names->emplace(name.substr(0, base::kLongestQuote));
}

absl::Status BadTransform(const OscMessage& message, absl::string_view got) {
  return absl::InvalidArgumentError(
      absl::StrCat(message.address, ": expected a name, a position within ",
                   static_cast<int>(kMaxCapturePosition), " m and a quaternion, got ", got));
}

}  // namespace

VmcReader::VmcReader() {
  for (const HumanoidBone& bone : HumanoidBones()) names_.emplace_back(bone.name);
}

absl::Status VmcReader::Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) {
  const std::size_t before = frames->size();
  absl::Status status = ForEachOscMessage(
      datagram, [&](const OscMessage& message) { return ReadMessage(message, frames); });
  if (arrived_.any() && expected_.any() && (expected_ & ~arrived_).none()) CloseFrame(frames);
  // Only a datagram that repeats bones for its own sake has more.
  if (frames->size() - before > std::size_t{kMaxFramesInDatagram}) {
    frames->resize(before + std::size_t{kMaxFramesInDatagram});
  }
  return status;
}

std::string VmcReader::Missing() const {
  const std::set<std::string>& others = other_bones_.empty() ? other_addresses_ : other_bones_;
  return absl::StrCat("VMC: expected ", kBone, " with Unity's bones (", absl::StrJoin(names_, ", "),
                      "), got ",
                      others.empty()         ? "none of them"
                      : other_bones_.empty() ? "only "
                                             : "only the bones ",
                      absl::StrJoin(others, ", ", [](std::string* out, const std::string& name) {
                        absl::StrAppend(out, base::Quoted(name));
                      }));
}

std::vector<std::string> VmcReader::TakeNotes() { return std::exchange(notes_, {}); }

absl::Status VmcReader::ReadMessage(const OscMessage& message, std::vector<CaptureFrame>* frames) {
  if (message.address == kBone) return ReadBone(message, frames);
  if (message.address == kRoot) {
    absl::string_view name;
    const absl::StatusOr<Transform> root = ReadTransform(message, &name);
    if (!root.ok()) return root.status();
    root_ = *root;
    return absl::OkStatus();
  }
  if (message.address != kTime) {
    Remember(message.address, &other_addresses_);
    return absl::OkStatus();
  }
  const absl::StatusOr<std::vector<OscArgument>> arguments = ReadOscArguments(message);
  if (!arguments.ok()) return arguments.status();
  if (arguments->empty() || (*arguments)[0].is_text ||
      !(std::abs((*arguments)[0].number) <= kMaxSenderSeconds)) {
    return absl::InvalidArgumentError(absl::StrCat(
        kTime, ": expected a time in seconds, got the types ", base::Quoted(message.types)));
  }
  if (arrived_.any()) CloseFrame(frames);
  seconds_ = (*arguments)[0].number;
  return absl::OkStatus();
}

absl::Status VmcReader::ReadBone(const OscMessage& message, std::vector<CaptureFrame>* frames) {
  absl::string_view name;
  const absl::StatusOr<Transform> transform = ReadTransform(message, &name);
  if (!transform.ok()) return transform.status();
  const int bone = FindHumanoidBone(name);
  if (bone < 0) {
    Remember(name, &other_bones_);
    return absl::OkStatus();
  }
  if (arrived_[Index(bone)]) CloseFrame(frames);
  arrived_[Index(bone)] = true;
  bones_[Index(bone)] = *transform;
  return absl::OkStatus();
}

absl::StatusOr<VmcReader::Transform> VmcReader::ReadTransform(const OscMessage& message,
                                                              absl::string_view* name) {
  const absl::StatusOr<std::vector<OscArgument>> arguments = ReadOscArguments(message);
  if (!arguments.ok()) return arguments.status();
  if (arguments->size() < kTransformArguments || !arguments->front().is_text) {
    return BadTransform(message, absl::StrCat("the types ", base::Quoted(message.types)));
  }
  *name = arguments->front().text;
  double values[kTransformArguments - 1];
  for (std::size_t i = 0; i + 1 < kTransformArguments; ++i) {
    const OscArgument& argument = (*arguments)[i + 1];
    if (argument.is_text || !(std::abs(argument.number) <= double{kMaxCapturePosition})) {
      return BadTransform(message, absl::StrCat(argument.number, " for ", base::Quoted(*name)));
    }
    values[i] = argument.number;
  }
  return Transform{{values[0], values[1], values[2]},
                   retargeting::Normalised({values[6], values[3], values[4], values[5]})};
}

void VmcReader::CloseFrame(std::vector<CaptureFrame>* frames) {
  expected_ = previous_ | arrived_;
  previous_ = arrived_;
  arrived_.reset();
  frames->push_back({std::exchange(seconds_, std::nullopt), Positions()});
  if (++frame_count_ == kNotesAfterFrames) MakeNotes();
}

// Forward kinematics, in Unity's axes: the formulas are the same in both.
std::vector<motion::Vec3> VmcReader::Positions() const {
  const auto& bones = HumanoidBones();
  std::vector<Vec3d> positions(bones.size());
  std::vector<Quaternion> rotations(bones.size());
  std::vector<Vec3d> skipped(bones.size());  // of the built-in person: offsets of missing bones
  for (std::size_t bone = 0; bone < bones.size(); ++bone) {
    const bool is_root = bones[bone].parent < 0;
    const std::size_t parent = is_root ? bone : Index(bones[bone].parent);
    const Vec3d above = is_root ? root_.position : positions[parent];
    const Quaternion turned = is_root ? root_.rotation : rotations[parent];
    const Vec3d built_in = skipped[parent] + Mirrored(bones[bone].offset);
    if (!bones_[bone].has_value()) {
      // Where its nearest ancestor is, so that its children are chained to that one.
      positions[bone] = above;
      rotations[bone] = turned;
      skipped[bone] = built_in;
      continue;
    }
    const Vec3d offset = bones_[bone]->position;
    positions[bone] = above + Rotate(turned, Norm(offset) < kNoOffset ? built_in : offset);
    rotations[bone] = turned * bones_[bone]->rotation;
  }
  // Ends of limbs that never came: the rest pose.
  for (std::size_t bone = 0; bone < bones.size(); ++bone) {
    positions[bone] += bones_[bone].has_value() ? Vec3d{} : Rotate(rotations[bone], skipped[bone]);
  }
  PlaceMissing(&positions);
  std::vector<motion::Vec3> world;
  for (const Vec3d& position : positions) world.push_back(ToFloat(Mirrored(position)));
  return world;
}

// Places each missing bone that has a child between its parent and that child, in the proportions
// of the built-in person.
void VmcReader::PlaceMissing(std::vector<Vec3d>* positions) const {
  const auto& bones = HumanoidBones();
  for (std::size_t bone = 0; bone < bones.size(); ++bone) {
    if (bones_[bone].has_value() || bones[bone].parent < 0) continue;
    std::size_t descendant = bone;
    double below = 0;
    for (std::size_t next = bone + 1; next < bones.size(); ++next) {
      if (Index(bones[next].parent) != descendant) continue;
      descendant = next;
      below += Norm(bones[next].offset);
      if (bones_[next].has_value()) break;
    }
    if (!bones_[descendant].has_value()) continue;
    const Vec3d parent = (*positions)[Index(bones[bone].parent)];
    const double above = Norm(bones[bone].offset);
    (*positions)[bone] = parent + ((*positions)[descendant] - parent) * (above / (above + below));
  }
}

void VmcReader::MakeNotes() {
  std::vector<std::string> missing;
  int bare = 0;
  for (std::size_t bone = 0; bone < kHumanoidBoneCount; ++bone) {
    if (!bones_[bone].has_value()) missing.push_back(names_[bone]);
    if (bones_[bone].has_value() && Norm(bones_[bone]->position) < kNoOffset) ++bare;
  }
  if (!missing.empty()) {
    notes_.push_back(absl::StrCat("VMC: the sender leaves out ", absl::StrJoin(missing, ", "),
                                  "; the bones beyond are chained to their nearest ancestor"));
  }
  if (bare > 1) {
    notes_.push_back(absl::StrCat("VMC: ", bare,
                                  " bones have no position; a built-in person of 1.6 m "
                                  "supplies their lengths"));
  }
}

}  // namespace duet::client::capture
