#include "model/formats/bvh/bvh_character.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/index.h"
#include "model/retargeting/rest_rig.h"

namespace duet::formats::bvh {
namespace {

using retargeting::CharacterRig;
using retargeting::Vec3d;

// How FormatBvh and ParseBvh name an End Site after its joint.
constexpr char kEndSuffix[] = ".end";
// Length of a last bone if its file does not state it, as a fraction of the bone before it.
constexpr double kLastBone = 0.25;

using base::Index;

class HierarchyWriter {
 public:
  HierarchyWriter(const CharacterRig& rig, double metres_per_unit)
      : rig_(rig), units_per_metre_(1 / metres_per_unit), children_(rig.names.size()) {
    for (int parent : rig.parents) {
      if (parent >= 0) ++children_[Index(parent)];
    }
  }

  // `places` receives the index of each rig joint in the document.
  BvhDocument Write(std::vector<int>* places) {
    places->assign(rig_.names.size(), -1);
    for (int joint : retargeting::DepthFirst(rig_.parents)) {
      (*places)[Index(joint)] = static_cast<int>(document_.joints.size());
      AddJoint(joint, *places);
    }
    return std::move(document_);
  }

 private:
  void AddJoint(int j, const std::vector<int>& places) {
    const int parent = rig_.parents[Index(j)];
    const bool leaf = children_[Index(j)] == 0;
    BvhJoint joint;
    joint.name = rig_.names[Index(j)];
    joint.parent = parent < 0 ? -1 : places[Index(parent)];
    if (parent >= 0) joint.offset = OffsetOf(j) * units_per_metre_;
    joint.end_site = leaf && IsEndOf(j);
    if (!joint.end_site) joint.channels = ChannelsOf(parent < 0);
    document_.joints.push_back(std::move(joint));
    if (leaf && !document_.joints.back().end_site) AddEndSite(OffsetOf(j) * kLastBone);
  }

  // Whether the joint is an end that the rig stores as a joint, and its parent's only child.
  bool IsEndOf(int j) const {
    const int parent = rig_.parents[Index(j)];
    return parent >= 0 && children_[Index(parent)] == 1 &&
           rig_.names[Index(j)] == absl::StrCat(rig_.names[Index(parent)], kEndSuffix);
  }

  Vec3d OffsetOf(int j) const {
    const int parent = rig_.parents[Index(j)];
    return parent < 0 ? Vec3d{} : rig_.positions[Index(j)] - rig_.positions[Index(parent)];
  }

  void AddEndSite(Vec3d offset) {
    BvhJoint end;
    end.name = document_.joints.back().name + kEndSuffix;
    end.parent = static_cast<int>(document_.joints.size()) - 1;
    end.offset = offset * units_per_metre_;
    end.end_site = true;
    document_.joints.push_back(std::move(end));
  }

  static std::vector<BvhChannel> ChannelsOf(bool root) {
    const std::vector<BvhChannel> turns = {BvhChannel::kZRotation, BvhChannel::kXRotation,
                                           BvhChannel::kYRotation};
    if (!root) return turns;
    std::vector<BvhChannel> channels = {BvhChannel::kXPosition, BvhChannel::kYPosition,
                                        BvhChannel::kZPosition};
    channels.insert(channels.end(), turns.begin(), turns.end());
    return channels;
  }

  const CharacterRig& rig_;
  double units_per_metre_;
  std::vector<int> children_;  // [rig joints], their number
  BvhDocument document_;
};

}  // namespace

BvhDocument ToBvh(const CharacterRig& rig, const std::vector<retargeting::CharacterPose>& poses,
                  double frame_rate_hz, double metres_per_unit, const BvhKeys& keys) {
  std::vector<int> places;
  BvhDocument document = HierarchyWriter(rig, metres_per_unit).Write(&places);
  std::vector<BvhTrack> tracks(document.joints.size());
  for (BvhTrack& track : tracks) {
    track.turns.resize(poses.size());
    track.places.resize(poses.size());
  }
  for (std::size_t frame = 0; frame < poses.size(); ++frame) {
    const retargeting::LocalPose local = ToLocal(rig, poses[frame]);
    for (std::size_t j = 0; j < rig.names.size(); ++j) {
      BvhTrack& track = tracks[Index(places[j])];
      track.turns[frame] = local.turns[j];
      track.places[frame] = local.places[j] * (1 / metres_per_unit);
    }
  }
  WriteMotion(tracks, frame_rate_hz, keys, &document);
  return document;
}

}  // namespace duet::formats::bvh
