#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/index.h"
#include "model/base/median.h"
#include "model/base/text.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/formats/gltf/gltf_track.h"
#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::gltf {
namespace {

constexpr std::size_t kMostCharacters = 64;
constexpr std::size_t kMostNames = 20;  // of animations, in messages
// A body that moves less, as a fraction of its size, stands still: a T pose with constant keys.
constexpr double kLeastTravel = 0.01;

using base::Index;
using retargeting::Affine;
using retargeting::Normalised;
using retargeting::Origin;
using retargeting::Vec3d;

// The nodes of a character and their ancestors.
struct Members {
  std::vector<int> above;  // from the outermost one to the root's parent
  std::vector<int> nodes;  // the root and all below it, parents first
};

// The times of the first and last keys of all tracks, and the rate of keys.
struct Timing {
  double start = 0, end = 0;
  double rate_hz = 0;
};

// Keys farther apart than this were set by hand and do not indicate a rate.
constexpr double kSlowestKeysHz = 15, kHandKeyedRateHz = 30, kFastestRateHz = 240;
constexpr double kRateTolerance = 0.01;
// Frames, spread over an animation, in which its travel is measured.
constexpr int kMeasuredFrames = 64;

Affine FromMatrix(const std::array<double, 16>& m) {
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

double RateOfKeys(const std::vector<float>& times) {
  if (times.size() < 2) return 0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(static_cast<double>(times[i]) - static_cast<double>(times[i - 1]));
  }
  const double rate = 1 / base::Median(std::move(steps)), whole = std::round(rate);
  return std::abs(rate - whole) < kRateTolerance * whole ? whole : rate;
}

// The nodes of a character with their tracks.
class Puppet {
 public:
  // `document` must outlive this object.
  Puppet(const GltfDocument& document, Members members)
      : document_(&document), members_(std::move(members)) {
    tracks_.resize(document.nodes.size());
    world_.resize(document.nodes.size());
    is_member_.resize(document.nodes.size());
    moves_.resize(document.nodes.size());
    for (int node : members_.nodes) is_member_[Index(node)] = moves_[Index(node)] = true;
    for (int node : members_.above) moves_[Index(node)] = true;
  }

  const Members& members() const { return members_; }

  bool IsMovedBy(const GltfAnimation& animation) const {
    return std::any_of(
        animation.channels.begin(), animation.channels.end(),
        [this](const GltfChannel& channel) { return is_member_[Index(channel.node)]; });
  }

  // Replaces the tracks. Errors: those of GltfTrack::Read.
  absl::Status ReadTracks(const GltfAnimation& animation, GltfBuffers* buffers) {
    for (std::vector<GltfTrack>& tracks : tracks_) tracks.clear();
    for (const GltfChannel& channel : animation.channels) {
      if (!moves_[Index(channel.node)]) continue;
      absl::StatusOr<GltfTrack> track = GltfTrack::Read(channel, buffers);
      if (!track.ok()) return track.status();
      tracks_[Index(channel.node)].push_back(*std::move(track));
    }
    return absl::OkStatus();
  }

  // Hand-keyed animations, whose keys are far apart, have a rate of 30 Hz.
  Timing FindTiming() const {
    Timing timing;
    timing.rate_hz = kHandKeyedRateHz;
    std::size_t most_keys = 0;
    bool first = true;
    for (const std::vector<GltfTrack>& tracks : tracks_) {
      for (const GltfTrack& track : tracks) {
        const double start = static_cast<double>(track.times.front());
        const double end = static_cast<double>(track.times.back());
        timing.start = first ? start : std::min(timing.start, start);
        timing.end = first ? end : std::max(timing.end, end);
        first = false;
        if (track.times.size() <= most_keys) continue;
        most_keys = track.times.size();
        const double rate = RateOfKeys(track.times);
        timing.rate_hz = rate < kSlowestKeysHz ? kHandKeyedRateHz : std::min(rate, kFastestRateHz);
      }
    }
    return timing;
  }

  // The rest pose: lengths in the world's unit, each bone in its parent's axes.
  retargeting::JointTree Tree() {
    Stand(std::nullopt);
    retargeting::JointTree tree;
    std::vector<int> places(document_->nodes.size(), -1);
    for (int node : members_.nodes) {
      const GltfNode& written = document_->nodes[Index(node)];
      const int parent = tree.names.empty() ? -1 : places[Index(written.parent)];
      const double scale = written.parent < 0 ? 1 : world_[Index(written.parent)].Scale();
      const Vec3d at = Local(node, std::nullopt).origin;
      places[Index(node)] = static_cast<int>(tree.names.size());
      tree.names.push_back(written.name);
      tree.parents.push_back(parent);
      tree.offsets.push_back(parent < 0 ? Vec3d{} : at * scale);
    }
    return tree;
  }

  // The places of the members in the world.
  std::vector<motion::Vec3> PoseAt(double seconds) {
    Stand(seconds);
    std::vector<motion::Vec3> pose;
    pose.reserve(members_.nodes.size());
    for (int node : members_.nodes) pose.push_back(ToFloat(world_[Index(node)].origin));
    return pose;
  }

  // How far the joints move from where they start: the mean of their largest distances, as a
  // fraction of the character's size.
  double Travel() {
    const Timing timing = FindTiming();
    std::vector<motion::Vec3> first;
    std::vector<float> farthest(members_.nodes.size());
    float size = 0;
    for (int frame = 0; frame < kMeasuredFrames; ++frame) {
      const double share = static_cast<double>(frame) / (kMeasuredFrames - 1);
      const std::vector<motion::Vec3> pose =
          PoseAt(timing.start + (timing.end - timing.start) * share);
      if (frame == 0) first = pose;
      for (std::size_t j = 0; j < pose.size(); ++j) {
        farthest[j] = std::max(farthest[j], Distance(pose[j], first[j]));
        size = std::max(size, Distance(pose[j], pose[0]));
      }
    }
    double sum = 0;
    for (float distance : farthest) sum += static_cast<double>(distance);
    return size > 0 ? sum / static_cast<double>(farthest.size()) / static_cast<double>(size) : 0;
  }

 private:
  // The parts of a node's transform that tracks move, and those that they do not.
  retargeting::Parts PartsAt(int node, double seconds) const {
    const GltfNode& written = document_->nodes[Index(node)];
    retargeting::Parts parts{written.translation, Normalised(written.rotation), written.scale};
    for (const GltfTrack& track : tracks_[Index(node)]) {
      if (track.channel.path == GltfPath::kRotation) parts.rotation = track.RotationAt(seconds);
      if (track.channel.path == GltfPath::kTranslation) parts.translation = track.VectorAt(seconds);
      if (track.channel.path == GltfPath::kScale) parts.scale = track.VectorAt(seconds);
    }
    return parts;
  }

  // The transform in the parent's axes; at rest if `seconds` is absent.
  Affine Local(int node, std::optional<double> seconds) const {
    const GltfNode& written = document_->nodes[Index(node)];
    if (seconds.has_value() && !tracks_[Index(node)].empty()) {
      return FromParts(PartsAt(node, *seconds));
    }
    if (written.matrix.has_value()) return FromMatrix(*written.matrix);
    return retargeting::FromParts(
        {written.translation, Normalised(written.rotation), written.scale});
  }

  void Stand(std::optional<double> seconds) {
    for (const std::vector<int>* nodes : {&members_.above, &members_.nodes}) {
      for (int node : *nodes) {
        const int parent = document_->nodes[Index(node)].parent;
        const Affine local = Local(node, seconds);
        world_[Index(node)] = parent < 0 ? local : world_[Index(parent)] * local;
      }
    }
  }

  const GltfDocument* document_;
  Members members_;
  std::vector<std::vector<GltfTrack>> tracks_;  // [nodes]
  std::vector<bool> is_member_;                 // [nodes]
  std::vector<bool> moves_;                     // [nodes], members and their ancestors
  std::vector<Affine> world_;                   // [nodes]
};

// Returns -1 if the nodes are in different trees.
int CommonAncestor(const std::vector<GltfNode>& nodes, int a, int b) {
  while (a != b && a >= 0 && b >= 0) {
    int& deeper = nodes[Index(a)].depth >= nodes[Index(b)].depth ? a : b;
    deeper = nodes[Index(deeper)].parent;
  }
  return a == b ? a : -1;
}

Members MembersOf(const std::vector<GltfNode>& nodes, int root) {
  Members members;
  for (int node = nodes[Index(root)].parent; node >= 0; node = nodes[Index(node)].parent) {
    members.above.push_back(node);
  }
  std::reverse(members.above.begin(), members.above.end());
  std::vector<int> open = {root};
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    members.nodes.push_back(node);
    const std::vector<int>& children = nodes[Index(node)].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return members;
}

// Finds the roots of the characters, in the order of the file.
class CharacterFinder {
 public:
  explicit CharacterFinder(const GltfDocument& document) : document_(document) {}

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
      const int common = CommonAncestor(document_.nodes, root, joint);
      if (common >= 0) root = common;
    }
    return root;
  }

  // Two roots are one character if one is above the other, or, without skins, in the same tree.
  void Add(int root) {
    for (int& known : roots_) {
      const int common = CommonAncestor(document_.nodes, known, root);
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
  std::vector<int> roots_;
};

class Importer {
 public:
  Importer(const GltfDocument& document, const GltfFileReader& read_file,
           const GltfImportOptions& options)
      : document_(document), buffers_(document, read_file), options_(options) {}

  absl::StatusOr<motion::Clip> Import(absl::string_view source) {
    const std::vector<int> roots = CharacterFinder(document_).Find();
    if (roots.empty())
      return Error(source, "expected a skeleton, got no skin and no animated node");
    if (options_.report != nullptr) options_.report->people = static_cast<int>(roots.size());
    const std::size_t person = Index(options_.person) < roots.size() ? Index(options_.person) : 0;
    Puppet puppet(document_, MembersOf(document_.nodes, roots[person]));
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
      options_.report->frame_rate = retargeting::Setting{
          absl::StrCat(timing.rate_hz, " Hz"), stated ? Origin::kFile : Origin::kGuessed,
          stated ? "" : "as the animation's keys suggest"};
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
