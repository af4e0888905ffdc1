#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/index.h"
#include "model/base/text.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/formats/gltf/gltf_puppet.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::gltf {
namespace {

constexpr std::size_t kMostCharacters = 64;
constexpr std::size_t kMostNames = 20;  // of animations, in messages
// A body that moves less, as a fraction of its size, stands still: a T pose with constant keys.
constexpr double kLeastTravel = 0.01;

using base::Index;

class Hierarchy {
 public:
  explicit Hierarchy(const GltfDocument& document) : nodes_(document.nodes) {}

  // Returns -1 if the nodes are in different trees.
  int CommonAncestor(int a, int b) const {
    while (a != b && a >= 0 && b >= 0) {
      int& deeper = nodes_[Index(a)].depth >= nodes_[Index(b)].depth ? a : b;
      deeper = nodes_[Index(deeper)].parent;
    }
    return a == b ? a : -1;
  }

  Members MembersOf(int root) const {
    Members members;
    for (int node = nodes_[Index(root)].parent; node >= 0; node = nodes_[Index(node)].parent) {
      members.above.push_back(node);
    }
    std::reverse(members.above.begin(), members.above.end());
    std::vector<int> open = {root};
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      members.nodes.push_back(node);
      const std::vector<int>& children = nodes_[Index(node)].children;
      open.insert(open.end(), children.rbegin(), children.rend());
    }
    return members;
  }

 private:
  const std::vector<GltfNode>& nodes_;
};

// Finds the roots of the characters, in the order of the file.
class CharacterFinder {
 public:
  CharacterFinder(const GltfDocument& document, const Hierarchy& hierarchy)
      : document_(document), hierarchy_(hierarchy) {}

  std::vector<int> Find() {
    for (const GltfSkin& skin : document_.skins) Add(RootOf(skin.joints));
    if (!roots_.empty()) return std::move(roots_);
    std::set<int> moved;
    for (const GltfAnimation& animation : document_.animations) {
      for (const GltfChannel& channel : animation.channels) {
        if (moved.insert(channel.node).second) Add(channel.node);
      }
    }
    return std::move(roots_);
  }

 private:
  // The common ancestor of all joints, or of the first ones if there is none.
  int RootOf(const std::vector<int>& joints) const {
    int root = joints[0];
    for (int joint : joints) {
      const int common = hierarchy_.CommonAncestor(root, joint);
      if (common >= 0) root = common;
    }
    return root;
  }

  // Two roots are one character if one is above the other, or, without skins, in the same tree.
  void Add(int root) {
    for (int& known : roots_) {
      const int common = hierarchy_.CommonAncestor(known, root);
      if (common < 0) continue;
      if (common == known) return;
      if (common == root || document_.skins.empty()) {
        known = common;
        return;
      }
    }
    if (roots_.size() < kMostCharacters) roots_.push_back(root);
  }

  const GltfDocument& document_;
  const Hierarchy& hierarchy_;
  std::vector<int> roots_;
};

class Importer {
 public:
  Importer(const GltfDocument& document, const GltfFileReader& read_file,
           const GltfImportOptions& options)
      : document_(document), buffers_(document, read_file), options_(options) {}

  absl::StatusOr<motion::Clip> Import(absl::string_view source) {
    const Hierarchy hierarchy(document_);
    const std::vector<int> roots = CharacterFinder(document_, hierarchy).Find();
    if (roots.empty())
      return Error(source, "expected a skeleton, got no skin and no animated node");
    if (options_.report != nullptr) options_.report->people = static_cast<int>(roots.size());
    const std::size_t person = Index(options_.person) < roots.size() ? Index(options_.person) : 0;
    Puppet puppet(document_, hierarchy.MembersOf(roots[person]));
    if (puppet.members().nodes.size() > motion::kMaxFileJoints) {
      return Error(source, absl::StrCat("skeleton: expected at most ", motion::kMaxFileJoints,
                                        " nodes, got ", puppet.members().nodes.size()));
    }
    if (options_.nodes != nullptr) *options_.nodes = puppet.members().nodes;
    const absl::StatusOr<std::vector<const GltfAnimation*>> candidates = Candidates(puppet, source);
    if (!candidates.ok()) return candidates.status();
    if (candidates->empty() && options_.nodes == nullptr) {
      return Error(source, "expected an animation of the skeleton, got none");
    }
    const absl::Status status = Choose(*candidates, &puppet);
    if (!status.ok()) return Error(source, status.message(), status.code());
    return Play(&puppet, source);
  }

 private:
  static absl::Status Error(absl::string_view source, absl::string_view message,
                            absl::StatusCode code = absl::StatusCode::kInvalidArgument) {
    return absl::Status(code, absl::StrCat(source, ": ", message));
  }

  void Remark(std::string what) const {
    if (options_.report != nullptr) options_.report->remarks.push_back(std::move(what));
  }

  // The animations with keys for the character; only the one of the given name if there is a name.
  absl::StatusOr<std::vector<const GltfAnimation*>> Candidates(const Puppet& puppet,
                                                               absl::string_view source) const {
    std::vector<const GltfAnimation*> candidates;
    for (const GltfAnimation& animation : document_.animations) {
      if (puppet.IsMovedBy(animation)) candidates.push_back(&animation);
    }
    if (!options_.animation.has_value()) return candidates;
    for (const GltfAnimation* animation : candidates) {
      if (IsNamed(*animation, *options_.animation)) return std::vector{animation};
    }
    return Error(source, absl::StrCat("animation: expected ",
                                      candidates.empty() ? "one" : NamesOf(candidates), ", got ",
                                      base::Quoted(*options_.animation)));
  }

  static std::string NamesOf(const std::vector<const GltfAnimation*>& animations) {
    std::vector<std::string> names;
    for (const GltfAnimation* animation : animations) {
      if (names.size() < kMostNames) names.push_back(base::Quoted(animation->name));
    }
    if (animations.size() > names.size()) names.push_back("...");
    return absl::StrJoin(names, ", ");
  }

  // Gives the puppet the tracks of the first animation in which the body moves. If it moves in
  // none, the one in which it moves most.
  absl::Status Choose(const std::vector<const GltfAnimation*>& candidates, Puppet* puppet) {
    const Puppet still = *puppet;
    std::size_t chosen = 0;
    double most = -1;
    for (std::size_t i = 0; i < candidates.size() && most < kLeastTravel; ++i) {
      Puppet candidate = still;
      const absl::Status status = candidate.ReadTracks(*candidates[i], &buffers_);
      if (!status.ok()) return status;
      const double travel = candidate.Travel();
      if (travel <= most) continue;
      most = travel;
      chosen = i;
      *puppet = std::move(candidate);
    }
    if (candidates.size() > 1) {
      Remark(
          absl::StrCat("animation: ", base::Quoted(candidates[chosen]->name),
                       chosen == 0 ? ", the first of " : ", the first in which the body moves of ",
                       candidates.size(), " that move the skeleton: ", NamesOf(candidates)));
    }
    if (!candidates.empty() && most == 0) {
      Remark(absl::StrCat("warning: animation: ", base::Quoted(candidates[chosen]->name),
                          ": no joint moves"));
    }
    return absl::OkStatus();
  }

  // Blender prefixes an animation with its armature ("Rig|walk").
  static bool IsNamed(const GltfAnimation& animation, absl::string_view name) {
    return animation.name == name || absl::EndsWith(animation.name, absl::StrCat("|", name));
  }

  absl::StatusOr<motion::Clip> Play(Puppet* puppet, absl::string_view source) const {
    Timing timing = puppet->FindTiming();
    const std::optional<double> stated = StatedRate();
    timing.rate_hz = options_.frame_rate_hz.value_or(stated.value_or(timing.rate_hz));
    if (options_.report != nullptr) {
      options_.report->frame_rate = stated.has_value()
                                        ? retargeting::Setting{absl::StrCat(timing.rate_hz, " Hz"),
                                                               retargeting::Origin::kFile, ""}
                                        : retargeting::Setting{absl::StrCat(timing.rate_hz, " Hz"),
                                                               retargeting::Origin::kGuessed,
                                                               "as the animation's keys suggest"};
    }
    // Rounding must not drop the last frame.
    const double frames = std::floor((timing.end - timing.start) * timing.rate_hz + 1e-3) + 1;
    if (!(frames <= motion::kMaxMotionFrames)) {
      return Error(source, absl::StrCat("animation: expected at most ", motion::kMaxMotionFrames,
                                        " frames, got ", timing.end - timing.start, " s"));
    }
    retargeting::Character character;
    character.tree = puppet->Tree();
    character.frame_count = static_cast<int>(frames);
    character.frame_rate_hz = timing.rate_hz;
    character.pose = [&](int frame) {
      return puppet->PoseAt(timing.start + frame / timing.rate_hz);
    };
    retargeting::CharacterOptions options = options_;
    if (document_.writer != kDuetsWriter) return ToClip(character, source, options);
    // The format's own values; the leg length of a child would suggest another unit.
    options.metres_per_unit = options.metres_per_unit.value_or(1);
    options.up_axis = options.up_axis.value_or(motion::UpAxis::kYUp);
    absl::StatusOr<motion::Clip> clip = ToClip(character, source, options);
    ReportOrigins();
    return clip;
  }

  // Unit and up axis come from the file unless the caller of the import gave them.
  void ReportOrigins() const {
    if (options_.report == nullptr) return;
    using retargeting::Origin;
    std::optional<retargeting::Setting>& unit = options_.report->unit;
    std::optional<retargeting::Setting>& up_axis = options_.report->up_axis;
    if (unit && !options_.metres_per_unit.has_value()) unit->origin = Origin::kFile;
    if (up_axis && !options_.up_axis.has_value()) up_axis->origin = Origin::kFile;
  }

  // The rate that a file written by Duet states, if it is valid.
  std::optional<double> StatedRate() const {
    if (document_.writer != kDuetsWriter || !document_.frame_rate_hz.has_value() ||
        !motion::CheckFrameRate("frame rate", *document_.frame_rate_hz).ok()) {
      return std::nullopt;
    }
    return document_.frame_rate_hz;
  }

  const GltfDocument& document_;
  GltfBuffers buffers_;
  const GltfImportOptions& options_;
};

}  // namespace

absl::StatusOr<motion::Clip> FromGltf(const GltfDocument& document, absl::string_view source,
                                      const GltfFileReader& read_file,
                                      const GltfImportOptions& options) {
  return Importer(document, read_file, options).Import(source);
}

}  // namespace duet::formats::gltf
