#include "contrib/formats/fbx/take_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "contrib/formats/fbx/scale_inheritance.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::contrib::formats::fbx {
namespace {

using retargeting::Affine;
using retargeting::Parts;
using retargeting::Quaternion;
using retargeting::Vec3d;

// Samples of all nodes in all frames: 28 bytes each in the result.
constexpr double kMostSamples = 8e6;
constexpr double kUsualTicksPerSecond = 25;

Vec3d ToVector(const aiVector3D& a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

Quaternion ToRotation(const aiQuaternion& q) {
  return retargeting::Normalised({static_cast<double>(q.w), static_cast<double>(q.x),
                                  static_cast<double>(q.y), static_cast<double>(q.z)});
}

// The value at a time; `blend` interpolates between two keys.
template <typename Key, typename Value, typename Blend>
Value Sample(const Key* keys, unsigned count, double ticks,
             Value (*value)(const decltype(Key::mValue)&), Blend blend) {
  const Key* const end = keys + count;
  const Key* const after =
      std::upper_bound(keys, end, ticks, [](double at, const Key& key) { return at < key.mTime; });
  if (after == keys) return value(keys->mValue);
  const Key& before = after[-1];
  if (after == end || !(after->mTime > before.mTime)) return value(before.mValue);
  const double share = (ticks - before.mTime) / (after->mTime - before.mTime);
  return blend(value(before.mValue), value(after->mValue), share);
}

Vec3d Lerp(Vec3d a, Vec3d b, double share) { return a + (b - a) * share; }

Parts Sampled(const aiNodeAnim& channel, const aiNode* node, double ticks) {
  Parts parts = node == nullptr ? Parts{} : ToParts(ToAffine(node->mTransformation));
  if (channel.mNumPositionKeys > 0) {
    parts.translation =
        Sample(channel.mPositionKeys, channel.mNumPositionKeys, ticks, ToVector, Lerp);
  }
  if (channel.mNumRotationKeys > 0) {
    parts.rotation = Sample(channel.mRotationKeys, channel.mNumRotationKeys, ticks, ToRotation,
                            retargeting::Slerp);
  }
  if (channel.mNumScalingKeys > 0) {
    parts.scale = Sample(channel.mScalingKeys, channel.mNumScalingKeys, ticks, ToVector, Lerp);
  }
  return parts;
}

// The first and last time of all keys, in ticks.
struct Span {
  double first = 0, last = 0;
  bool empty = true;

  template <typename Key>
  void Add(const Key* keys, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      first = empty ? keys[i].mTime : std::min(first, keys[i].mTime);
      last = empty ? keys[i].mTime : std::max(last, keys[i].mTime);
      empty = false;
    }
  }
};

using Channels = std::map<std::string, const aiNodeAnim*>;

Span SpanOf(const Channels& channels) {
  Span span;
  for (const auto& [name, channel] : channels) {
    const unsigned most =
        std::max({channel->mNumPositionKeys, channel->mNumRotationKeys, channel->mNumScalingKeys});
    // A channel of a pivot has one key at time 0 for each property that it does not animate.
    const auto add = [&span, most](const auto* keys, unsigned count) {
      if (count == most || count > 1) span.Add(keys, count);
    };
    add(channel->mPositionKeys, channel->mNumPositionKeys);
    add(channel->mRotationKeys, channel->mNumRotationKeys);
    add(channel->mScalingKeys, channel->mNumScalingKeys);
  }
  return span;
}

// The local transform of a node in a take. In a file with pivots, a channel is named after a part
// of the transform, or after the node; then it holds the whole transform, although the node has
// pivots.
class LocalMotion {
 public:
  LocalMotion(const Node& node, const Channels& channels) {
    const auto whole = channels.find(node.name);
    if (whole != channels.end()) {
      links_.push_back({node.chain.back(), whole->second});
      moved_ = true;
      if (const aiNode* post = PartOf(node, "PostRotation"))
        undo_post_ = ToParts(ToAffine(post->mTransformation)).rotation;
      return;
    }
    for (const char* part : kTransformParts) {
      const auto channel = channels.find(PivotName(node.name, part));
      const Link link{PartOf(node, part), channel == channels.end() ? nullptr : channel->second};
      moved_ = moved_ || link.channel != nullptr;
      if (link.node != nullptr || link.channel != nullptr) links_.push_back(link);
    }
    links_.push_back({node.chain.back(), nullptr});
  }

  bool moved() const { return moved_; }

  Affine At(double ticks) const {
    Affine local;
    for (const Link& link : links_) {
      local = local * (link.channel == nullptr ? ToAffine(link.node->mTransformation)
                                               : FromParts(Mended(link, ticks)));
    }
    return local;
  }

 private:
  struct Link {
    const aiNode* node;         // null if assimp left it out
    const aiNodeAnim* channel;  // null if it does not move
  };

  // The node that assimp added for a part of the transform, or null.
  static const aiNode* PartOf(const Node& node, const char* part) {
    const std::string name = PivotName(node.name, part);
    const auto found =
        std::find_if(node.chain.begin(), node.chain.end(),
                     [&name](const aiNode* link) { return name == link->mName.C_Str(); });
    return found == node.chain.end() ? nullptr : *found;
  }

  Parts Mended(const Link& link, double ticks) const {
    Parts parts = Sampled(*link.channel, link.node, ticks);
    if (undo_post_.has_value()) parts.rotation = parts.rotation * *undo_post_ * *undo_post_;
    return parts;
  }

  std::vector<Link> links_;  // from the outermost
  bool moved_ = false;
  // assimp multiplies a channel of the whole transform with the post-rotation, where FBX has its
  // inverse. This is the inverse.
  std::optional<Quaternion> undo_post_;
};

class TakeSampler {
 public:
  TakeSampler(const NodeTree& tree, const Channels& channels, double first, double ticks_per_frame)
      : tree_(tree), first_(first), ticks_per_frame_(ticks_per_frame) {
    for (const Node& node : tree.nodes) motions_.emplace_back(node, channels);
    for (std::size_t n = 0; n < motions_.size(); ++n) {
      moves_ = moves_ || motions_[n].moved();
      moves_skin_ = moves_skin_ || (tree.bound[n] && motions_[n].moved());
    }
  }

  // Errors: INVALID_ARGUMENT for a node that moves and has the name of another.
  absl::StatusOr<std::vector<Track>> Sample(int frames) const {
    std::vector<Track> tracks;
    if (!moves_) return tracks;
    const bool plainly = InheritsPlainly(frames);
    for (std::size_t n = 0; n < motions_.size(); ++n) {
      const std::string& name = tree_.nodes[n].name;
      if (motions_[n].moved() && tree_.counts.at(name) > 1) {
        return absl::InvalidArgumentError(
            absl::StrCat("nodes: expected a name for each animated node, got several named ",
                         base::Quoted(name), "; export each person to a file of its own"));
      }
      if (plainly && !IsTracked(n)) continue;
      tracks.emplace_back();
      tracks.back().node = static_cast<int>(n);
    }
    for (int frame = 0; frame < frames; ++frame) AppendFrame(frame, plainly, &tracks);
    return tracks;
  }

 private:
  // Bones that the take leaves in the saved pose are not at rest either.
  bool IsTracked(std::size_t n) const {
    return motions_[n].moved() || (tree_.bound[n] && moves_skin_);
  }

  Affine LocalAt(std::size_t n, int frame) const {
    return motions_[n].At(first_ + frame * ticks_per_frame_);
  }

  std::vector<Affine> LocalsAt(int frame) const {
    std::vector<Affine> locals;
    for (std::size_t n = 0; n < motions_.size(); ++n) locals.push_back(LocalAt(n, frame));
    return locals;
  }

  bool InheritsPlainly(int frames) const {
    const bool all = std::all_of(tree_.nodes.begin(), tree_.nodes.end(),
                                 [](const Node& node) { return node.inherits == Inherits::kAll; });
    for (int frame = 0; frame < frames && !all; ++frame) {
      if (!fbx::InheritsPlainly(tree_, LocalsAt(frame))) return false;
    }
    return true;
  }

  void AppendFrame(int frame, bool plainly, std::vector<Track>* tracks) const {
    const std::vector<Parts> inherited =
        plainly ? std::vector<Parts>() : InheritScales(tree_, LocalsAt(frame));
    for (Track& track : *tracks) {
      const auto n = static_cast<std::size_t>(track.node);
      Parts parts;
      if (plainly) {
        const Affine local = LocalAt(n, frame);
        parts = ToParts(tree_.nodes[n].parent < 0 ? tree_.root * local : local);
      } else {
        parts = inherited[n];
      }
      // A rotation and its negative are the same; neighbours must be on one side to interpolate.
      Quaternion& q = parts.rotation;
      if (!track.frames.empty() && Dot(q, track.frames.back().rotation) < 0) {
        q = {-q.w, -q.x, -q.y, -q.z};
      }
      track.frames.push_back(parts);
    }
  }

  const NodeTree& tree_;
  double first_, ticks_per_frame_;
  std::vector<LocalMotion> motions_;  // [nodes]
  bool moves_ = false, moves_skin_ = false;
};

}  // namespace

absl::StatusOr<std::vector<Track>> SampleTake(const aiAnimation& take, const NodeTree& tree,
                                              double frame_rate_hz) {
  Channels channels;
  for (unsigned i = 0; i < take.mNumChannels; ++i) {
    channels.emplace(take.mChannels[i]->mNodeName.C_Str(), take.mChannels[i]);
  }
  const Span span = SpanOf(channels);
  if (span.empty) return std::vector<Track>();
  const double ticks_per_second =
      take.mTicksPerSecond > 0 ? take.mTicksPerSecond : kUsualTicksPerSecond;
  const double ticks_per_frame = ticks_per_second / frame_rate_hz;
  // Rounding must not drop the last frame.
  const double frames = std::floor((span.last - span.first) / ticks_per_frame + 1e-3) + 1;
  if (!(frames <= motion::kMaxMotionFrames &&
        frames * static_cast<double>(tree.nodes.size()) <= kMostSamples)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "animation: expected at most ", motion::kMaxMotionFrames, " frames and ", kMostSamples,
        " transforms, got ", frames, " frames of ", tree.nodes.size(), " nodes"));
  }
  return TakeSampler(tree, channels, span.first, ticks_per_frame).Sample(static_cast<int>(frames));
}

}  // namespace duet::contrib::formats::fbx
