#include "model/formats/bvh/bvh_import.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/formats/bvh/bvh_document.h"

namespace duet::formats::bvh {
namespace {

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
    // A person's joints are contiguous.
    tree.parents.push_back(written.parent < 0 ? -1 : written.parent - joints.front());
    tree.offsets.push_back(written.offset);
  }
  return tree;
}

double FrameRate(const BvhDocument& document) {
  return RateOfFrameTime(document.frame_time_s, document.frame_time_decimals);
}

// Adds a note and a remark, which `duet inspect` prints.
void Remark(const std::string& what, const BvhImportOptions& options) {
  if (options.notes != nullptr) options.notes->push_back(what);
  if (options.report != nullptr) options.report->remarks.push_back(what);
}

void NoteFrameCount(const BvhDocument& document, const BvhImportOptions& options) {
  if (!document.stated_frame_count.has_value()) return;
  Remark(absl::StrCat("frames: the file has ", document.frame_count, ", and states ",
                      *document.stated_frame_count),
         options);
}

void NotePositionChannels(const BvhDocument& document, const BvhImportOptions& options) {
  const std::optional<PositionChannels> found = FindPositionChannels(document);
  if (!found.has_value()) return;
  const bool replace = *found == PositionChannels::kReplaceOffset;
  Remark(absl::StrCat("position channels below the root: ", replace ? "in place of" : "added to",
                      " OFFSET (as most joints have it)"),
         options);
}

void Report(const BvhDocument& document, double frame_rate_hz, retargeting::ReadingReport* report) {
  if (report == nullptr) return;
  report->people =
      static_cast<int>(std::count_if(document.joints.begin(), document.joints.end(),
                                     [](const BvhJoint& joint) { return joint.parent < 0; }));
  report->frame_rate =
      retargeting::Setting{absl::StrCat(frame_rate_hz, " Hz"), retargeting::Origin::kFile,
                           absl::StrCat("Frame Time ", document.frame_time_s)};
}

}  // namespace

absl::StatusOr<motion::Clip> FromBvh(const BvhDocument& document, absl::string_view source,
                                     const BvhImportOptions& options) {
  const std::vector<int> joints = JointsOfPerson(document, options.person);
  const BvhKinematics kinematics(document);
  NoteFrameCount(document, options);
  NotePositionChannels(document, options);
  Report(document, FrameRate(document), options.report);
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
