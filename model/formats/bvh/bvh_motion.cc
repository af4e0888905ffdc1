#include "model/formats/bvh/bvh_motion.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/angle.h"
#include "model/base/text.h"

namespace duet::formats::bvh {
namespace {

using retargeting::EulerAngles;
using retargeting::EulerOrder;
using retargeting::InBetween;
using retargeting::Quaternion;
using retargeting::Vec3d;

// The smallest reported deviation: one centimetre at the end of an arm.
constexpr double kReportedRadians = 1 / base::kDegreesPerRadian;

bool IsRotation(BvhChannel channel) { return channel >= BvhChannel::kXRotation; }

// 0 x, 1 y, 2 z.
int AxisOf(BvhChannel channel) {
  const BvhChannel first = IsRotation(channel) ? BvhChannel::kXRotation : BvhChannel::kXPosition;
  return static_cast<int>(channel) - static_cast<int>(first);
}

double Component(Vec3d a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

std::vector<Vec3d> WithPlacesBetween(const std::vector<Vec3d>& places, int keys) {
  std::vector<Vec3d> all;
  for (std::size_t frame = 0; frame + 1 < places.size(); ++frame) {
    const Vec3d step = (places[frame + 1] - places[frame]) * (1.0 / keys);
    for (int key = 0; key < keys; ++key) all.push_back(places[frame] + step * key);
  }
  if (!places.empty()) all.push_back(places.back());
  return all;
}

// The channel values of a joint at every key.
struct Values {
  std::vector<EulerAngles> angles;
  std::vector<Vec3d> places;
};

// Measures how far linear interpolation of angles between keys deviates from the rotation.
class BetweenFrames {
 public:
  // `keys_per_frame` of the written file.
  explicit BetweenFrames(int keys_per_frame) : keys_per_frame_(keys_per_frame) {}

  void Add(const std::string& joint, const std::vector<Quaternion>& turns,
           const std::vector<EulerAngles>& angles, EulerOrder order) {
    const InBetween here = LargestInBetween(turns, angles, order);
    if (here.radians <= kReportedRadians) return;
    enough_ = std::max(enough_, EnoughKeys(turns, order));
    if (here.radians <= largest_.radians) return;
    largest_ = here;
    joint_ = joint;
  }

  void Report(std::vector<std::string>* notes) const {
    if (joint_.empty()) return;
    notes->push_back(absl::StrFormat(
        "%s comes near gimbal lock: between frames, interpolated angles are up to %.1f degrees off "
        "(frame %d); %d keys per frame reduce this below %.0f",
        base::Quoted(joint_), largest_.radians * base::kDegreesPerRadian,
        static_cast<int>(largest_.frame) / keys_per_frame_, enough_,
        kReportedRadians * base::kDegreesPerRadian));
  }

 private:
  // Returns the sufficient number of keys per frame of the motion. `turns`: of the written keys.
  int EnoughKeys(const std::vector<Quaternion>& turns, EulerOrder order) const {
    for (int times = 2; times * keys_per_frame_ < kMostKeysPerFrame; times *= 2) {
      const std::vector<Quaternion> finer = WithKeysBetween(turns, times);
      if (LargestInBetween(finer, ToEulerTrack(finer, order), order).radians <= kReportedRadians) {
        return times * keys_per_frame_;
      }
    }
    return kMostKeysPerFrame;
  }

  int keys_per_frame_;
  int enough_ = 1;
  InBetween largest_;
  std::string joint_;
};

}  // namespace

std::optional<EulerOrder> RotationOrder(const BvhJoint& joint) {
  std::vector<int> axes;
  for (BvhChannel channel : joint.channels) {
    if (IsRotation(channel)) axes.push_back(AxisOf(channel));
  }
  if (axes.size() != 3 || axes[0] == axes[1] || axes[1] == axes[2] || axes[0] == axes[2]) {
    return std::nullopt;
  }
  return EulerOrder{axes[0], axes[1], axes[2]};
}

void WriteMotion(const std::vector<BvhTrack>& tracks, double frame_rate_hz, const BvhKeys& keys,
                 BvhDocument* document) {
  BetweenFrames between(keys.per_frame);
  std::vector<Values> joints(tracks.size());
  std::size_t key_count = 0;
  for (std::size_t j = 0; j < tracks.size(); ++j) {
    joints[j].places = WithPlacesBetween(tracks[j].places, keys.per_frame);
    key_count = std::max(key_count, joints[j].places.size());
    const std::optional<EulerOrder> order = RotationOrder(document->joints[j]);
    if (!order.has_value()) continue;
    const std::vector<Quaternion> turns = WithKeysBetween(tracks[j].turns, keys.per_frame);
    joints[j].angles = ToEulerTrack(turns, *order);
    if (keys.notes != nullptr) {
      between.Add(document->joints[j].name, turns, joints[j].angles, *order);
    }
  }
  document->frame_time_s = 1 / (frame_rate_hz * keys.per_frame);
  document->frame_count = static_cast<int>(key_count);
  document->values.clear();
  for (std::size_t key = 0; key < key_count; ++key) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      std::size_t turn = 0;
      for (BvhChannel channel : document->joints[j].channels) {
        const bool turns = IsRotation(channel) && !joints[j].angles.empty();
        const double value = turns ? joints[j].angles[key][turn++] * base::kDegreesPerRadian
                             : IsRotation(channel)
                                 ? 0
                                 : Component(joints[j].places[key], AxisOf(channel));
        document->values.push_back(static_cast<float>(value));
      }
    }
  }
  if (keys.notes != nullptr) between.Report(keys.notes);
}

}  // namespace duet::formats::bvh
