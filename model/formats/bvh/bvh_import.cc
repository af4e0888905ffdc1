#include "model/formats/bvh/bvh_import.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"

namespace duet::formats::bvh {
namespace {

// Frame times carry 3 to 7 digits.
constexpr double kRateTolerance = 5e-4;

// The joints below one ROOT.
std::vector<int> JointsOfPerson(const BvhDocument& document, int person) {
  std::vector<int> root_of(document.joints.size());
  int roots = 0;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    const int parent = document.joints[j].parent;
    root_of[j] = parent < 0 ? roots++ : root_of[static_cast<size_t>(parent)];
  }
  std::vector<int> joints;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    if (root_of[j] == (person < roots ? person : 0)) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

retargeting::JointTree TreeOf(const BvhDocument& document, const std::vector<int>& joints) {
  retargeting::JointTree tree;
  for (int joint : joints) {
    const BvhJoint& written = document.joints[static_cast<size_t>(joint)];
    tree.names.push_back(written.name);
    // One person's joints lie together.
    tree.parents.push_back(written.parent < 0 ? -1 : written.parent - joints.front());
    tree.offsets.push_back(written.offset);
  }
  return tree;
}

double FrameRate(const BvhDocument& document) {
  const double rate = 1 / document.frame_time_s;
  const double whole = std::round(rate);
  return whole >= 1 && std::abs(rate - whole) < kRateTolerance * whole ? whole : rate;
}

void NotePositionChannels(const BvhDocument& document, std::vector<std::string>* notes) {
  const std::optional<PositionChannels> found = FindPositionChannels(document);
  if (notes == nullptr || !found.has_value()) return;
  const bool replace = *found == PositionChannels::kReplaceOffset;
  notes->push_back(
      absl::StrCat("position channels below the root: ", replace ? "in place of" : "added to",
                   " OFFSET (as most joints have it)"));
}

}  // namespace

absl::StatusOr<motion::Clip> FromBvh(const BvhDocument& document, absl::string_view source,
                                     const BvhImportOptions& options) {
  const std::vector<int> joints = JointsOfPerson(document, options.person);
  const BvhKinematics kinematics(document);
  NotePositionChannels(document, options.notes);
  retargeting::Character character;
  character.tree = TreeOf(document, joints);
  character.frame_count = document.frame_count;
  character.frame_rate_hz = FrameRate(document);
  character.pose = [&](int frame) {
    const std::vector<retargeting::Vec3d> all = kinematics.Positions(frame);
    std::vector<motion::Vec3> pose;
    pose.reserve(joints.size());
    for (int joint : joints) pose.push_back(ToFloat(all[static_cast<size_t>(joint)]));
    return pose;
  };
  return ToClip(character, source, options);
}

}  // namespace duet::formats::bvh
