#include "model/formats/fbx/program/take_sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::fbx::program {
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

Affine Sampled(const aiNodeAnim& channel, const aiNode& node, double ticks) {
  Parts parts = ToParts(ToAffine(node.mTransformation));
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
  return FromParts(parts);
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
    span.Add(channel->mPositionKeys, channel->mNumPositionKeys);
    span.Add(channel->mRotationKeys, channel->mNumRotationKeys);
    span.Add(channel->mScalingKeys, channel->mNumScalingKeys);
  }
  return span;
}

bool IsMoved(const Node& node, const Channels& channels) {
  return std::any_of(node.chain.begin(), node.chain.end(), [&channels](const aiNode* link) {
    return channels.count(link->mName.C_Str()) > 0;
  });
}

Affine LocalAt(const Node& node, const Channels& channels, double ticks) {
  Affine local;
  for (const aiNode* link : node.chain) {
    const auto channel = channels.find(link->mName.C_Str());
    local = local * (channel == channels.end() ? ToAffine(link->mTransformation)
                                               : Sampled(*channel->second, *link, ticks));
  }
  return local;
}

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
  // Bones that the take leaves in the saved pose are not at rest either.
  bool moves_skin = false;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    moves_skin = moves_skin || (tree.bound[n] && IsMoved(tree.nodes[n], channels));
  }
  std::vector<Track> tracks;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const Node& node = tree.nodes[n];
    const bool moved = IsMoved(node, channels);
    if (!moved && !(moves_skin && tree.bound[n])) continue;
    if (moved && tree.counts.at(node.name) > 1) {
      return absl::InvalidArgumentError(
          absl::StrCat("nodes: expected a name for each animated node, got several named ",
                       base::Quoted(node.name), "; export each person to a file of its own"));
    }
    Track track;
    track.node = static_cast<int>(n);
    for (int frame = 0; frame < static_cast<int>(frames); ++frame) {
      Affine local = LocalAt(node, channels, span.first + frame * ticks_per_frame);
      if (node.parent < 0) local = tree.root * local;
      Parts parts = ToParts(local);
      // A rotation and its negative are the same; neighbours must be on one side to interpolate.
      Quaternion& q = parts.rotation;
      if (!track.frames.empty() && Dot(q, track.frames.back().rotation) < 0) {
        q = {-q.w, -q.x, -q.y, -q.z};
      }
      track.frames.push_back(parts);
    }
    tracks.push_back(std::move(track));
  }
  return tracks;
}

}  // namespace duet::formats::fbx::program
