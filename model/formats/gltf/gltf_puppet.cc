#include "model/formats/gltf/gltf_puppet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/index.h"
#include "model/base/median.h"

namespace duet::formats::gltf {
namespace {

// Relative. The times of keys are float32; a frame's time differs from its key by their rounding.
constexpr double kSameTime = 1e-6;
// Seconds. Keys nearer than this to each other stand for a jump between two values.
constexpr double kJump = 1e-3;

using base::Index;
using retargeting::Affine;
using retargeting::Normalised;
using retargeting::Quaternion;
using retargeting::Vec3d;

}  // namespace

absl::StatusOr<GltfTrack> GltfTrack::Read(const GltfChannel& channel, GltfBuffers* buffers) {
  GltfTrack track;
  track.channel_ = channel;
  track.components_ = channel.path == GltfPath::kRotation ? 4 : 3;
  absl::StatusOr<std::vector<float>> times = buffers->Read(channel.times, 1);
  if (!times.ok()) return times.status();
  absl::StatusOr<std::vector<float>> values =
      buffers->Read(channel.values, static_cast<int>(track.components_));
  if (!values.ok()) return values.status();
  const std::size_t parts = channel.interpolation == GltfInterpolation::kCubicSpline ? 3 : 1;
  if (times->empty() || values->size() != times->size() * parts * track.components_) {
    return absl::InvalidArgumentError(
        absl::StrCat("accessors[", channel.values, "]: expected ", parts,
                     " values for each of at least 1 key, got ", values->size() / track.components_,
                     " for ", times->size(), " keys"));
  }
  if (std::adjacent_find(times->begin(), times->end(), std::greater_equal<float>()) !=
      times->end()) {
    return absl::InvalidArgumentError(
        absl::StrCat("accessors[", channel.times, "]: expected increasing times, got others"));
  }
  track.times_ = *std::move(times);
  track.values_ = *std::move(values);
  return track;
}

GltfTrack::Place GltfTrack::Find(double seconds) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), seconds,
                                      [](double a, float b) { return a < static_cast<double>(b); });
  if (after == times_.begin()) return {};
  const std::size_t key = static_cast<std::size_t>(after - times_.begin()) - 1;
  if (after == times_.end()) return {key, 0, 0};
  const double from = static_cast<double>(times_[key]), to = static_cast<double>(*after);
  // Elsewhere, neighbouring values hardly differ.
  const bool jumps = channel_.interpolation == GltfInterpolation::kStep || to - from < kJump;
  if (jumps && to - seconds <= kSameTime * std::max(1.0, std::abs(to))) return Find(to);
  return {key, (seconds - from) / (to - from), to - from};
}

double GltfTrack::Get(std::size_t key, Part part, std::size_t component) const {
  const bool spline = channel_.interpolation == GltfInterpolation::kCubicSpline;
  const std::size_t row = spline ? key * 3 + static_cast<std::size_t>(part) : key;
  return static_cast<double>(values_[row * components_ + component]);
}

double GltfTrack::Interpolate(const Place& place, std::size_t component) const {
  const double from = Get(place.key, kValue, component);
  if (place.share == 0 || channel_.interpolation == GltfInterpolation::kStep) return from;
  const double to = Get(place.key + 1, kValue, component);
  const double t = place.share;
  if (channel_.interpolation == GltfInterpolation::kLinear) return from + (to - from) * t;
  // glTF 2.0, appendix C: tangents are changes per second.
  const double leaves = place.step_seconds * Get(place.key, kOutTangent, component);
  const double arrives = place.step_seconds * Get(place.key + 1, kInTangent, component);
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * leaves + (-2 * t3 + 3 * t2) * to +
         (t3 - t2) * arrives;
}

Vec3d GltfTrack::VectorAt(double seconds) const {
  const Place place = Find(seconds);
  return {Interpolate(place, 0), Interpolate(place, 1), Interpolate(place, 2)};
}

Quaternion GltfTrack::RotationAt(double seconds) const {
  const Place place = Find(seconds);
  const auto key = [this](std::size_t k) {
    return Normalised({Get(k, kValue, 3), Get(k, kValue, 0), Get(k, kValue, 1), Get(k, kValue, 2)});
  };
  if (channel_.interpolation == GltfInterpolation::kLinear && place.share > 0) {
    return Slerp(key(place.key), key(place.key + 1), place.share);
  }
  return Normalised(
      {Interpolate(place, 3), Interpolate(place, 0), Interpolate(place, 1), Interpolate(place, 2)});
}

namespace {

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

}  // namespace

Puppet::Puppet(const GltfDocument& document, Members members)
    : document_(&document), members_(std::move(members)) {
  tracks_.resize(document.nodes.size());
  world_.resize(document.nodes.size());
  is_member_.resize(document.nodes.size());
  moves_.resize(document.nodes.size());
  for (int node : members_.nodes) is_member_[Index(node)] = moves_[Index(node)] = true;
  for (int node : members_.above) moves_[Index(node)] = true;
}

bool Puppet::IsMovedBy(const GltfAnimation& animation) const {
  return std::any_of(
      animation.channels.begin(), animation.channels.end(),
      [this](const GltfChannel& channel) { return is_member_[Index(channel.node)]; });
}

absl::Status Puppet::ReadTracks(const GltfAnimation& animation, GltfBuffers* buffers) {
  for (std::vector<GltfTrack>& tracks : tracks_) tracks.clear();
  for (const GltfChannel& channel : animation.channels) {
    if (!moves_[Index(channel.node)]) continue;
    absl::StatusOr<GltfTrack> track = GltfTrack::Read(channel, buffers);
    if (!track.ok()) return track.status();
    tracks_[Index(channel.node)].push_back(*std::move(track));
  }
  return absl::OkStatus();
}

Timing Puppet::FindTiming() const {
  Timing timing;
  timing.rate_hz = kHandKeyedRateHz;
  std::size_t most_keys = 0;
  bool first = true;
  for (const std::vector<GltfTrack>& tracks : tracks_) {
    for (const GltfTrack& track : tracks) {
      const double start = static_cast<double>(track.times().front());
      const double end = static_cast<double>(track.times().back());
      timing.start = first ? start : std::min(timing.start, start);
      timing.end = first ? end : std::max(timing.end, end);
      first = false;
      if (track.times().size() <= most_keys) continue;
      most_keys = track.times().size();
      const double rate = RateOfKeys(track.times());
      timing.rate_hz = rate < kSlowestKeysHz ? kHandKeyedRateHz : std::min(rate, kFastestRateHz);
    }
  }
  return timing;
}

retargeting::JointTree Puppet::Tree() {
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

std::vector<motion::Vec3> Puppet::PoseAt(double seconds) {
  Stand(seconds);
  std::vector<motion::Vec3> pose;
  pose.reserve(members_.nodes.size());
  for (int node : members_.nodes) pose.push_back(ToFloat(world_[Index(node)].origin));
  return pose;
}

double Puppet::Travel() {
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

retargeting::Parts Puppet::PartsAt(int node, double seconds) const {
  const GltfNode& written = document_->nodes[Index(node)];
  retargeting::Parts parts{written.translation, Normalised(written.rotation), written.scale};
  for (const GltfTrack& track : tracks_[Index(node)]) {
    if (track.channel().path == GltfPath::kRotation) parts.rotation = track.RotationAt(seconds);
    if (track.channel().path == GltfPath::kTranslation) parts.translation = track.VectorAt(seconds);
    if (track.channel().path == GltfPath::kScale) parts.scale = track.VectorAt(seconds);
  }
  return parts;
}

Affine Puppet::Local(int node, std::optional<double> seconds) const {
  const GltfNode& written = document_->nodes[Index(node)];
  if (seconds.has_value() && !tracks_[Index(node)].empty()) {
    return FromParts(PartsAt(node, *seconds));
  }
  if (written.matrix.has_value()) return FromMatrix(*written.matrix);
  return retargeting::FromParts({written.translation, Normalised(written.rotation), written.scale});
}

void Puppet::Stand(std::optional<double> seconds) {
  for (const std::vector<int>* nodes : {&members_.above, &members_.nodes}) {
    for (int node : *nodes) {
      const int parent = document_->nodes[Index(node)].parent;
      const Affine local = Local(node, seconds);
      world_[Index(node)] = parent < 0 ? local : world_[Index(parent)] * local;
    }
  }
}

}  // namespace duet::formats::gltf
