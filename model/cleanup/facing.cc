#include "model/cleanup/facing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/low_pass.h"
#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

constexpr Vec3 kUp{0, 1, 0};

float Float(double value) { return static_cast<float>(value); }

// An angle as -pi to pi.
float Wrapped(float angle) { return std::remainder(angle, Float(2 * base::kPi)); }

// `v` along the floor, of length 1; {} if it has no direction.
Vec3 LevelUnit(Vec3 v) {
  const Vec3 level = Level(v);
  const float length = Norm(level);
  return length > 0 ? level / length : Vec3{};
}

// The angle about the vertical from `from` to `to`.
float AngleBetween(Vec3 from, Vec3 to) {
  return std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
}

// Which way a body faces and where its leader is, in every frame.
class View {
 public:
  View(const motion::Skeleton& skeleton, const body::Body& body, const motion::Poses& leader,
       const motion::Poses& follower) {
    const auto across = [&](const motion::JointPair& pair, int t) {
      return LevelUnit(follower.at(t, pair.right) - follower.at(t, pair.left));
    };
    facing_.reserve(static_cast<std::size_t>(follower.frame_count()));
    offset_.reserve(facing_.capacity());
    for (int t = 0; t < follower.frame_count(); ++t) {
      facing_.push_back(
          LevelUnit(Cross(kUp, across(*skeleton.hips, t) + across(*body.shoulders, t))));
      const Vec3 way = leader.at(t, skeleton.root) - follower.at(t, skeleton.root);
      offset_.push_back(Level(way));
    }
  }

  void Smooth(double sigma_frames) {
    facing_ = LowPass(facing_, sigma_frames);
    offset_ = LowPass(offset_, sigma_frames);
  }

  // Whether the body is ever turned away farther than it may be.
  template <typename Most>
  bool IsEverAway(const Most& most) const {
    for (int t = 0; t < static_cast<int>(facing_.size()); ++t) {
      if (std::abs(Away(t)) > most(t)) return true;
    }
    return false;
  }
  // How far the body must turn to face the leader.
  float Away(int frame) const { return AngleBetween(At(facing_, frame), At(offset_, frame)); }
  // How far apart the two are.
  float Metres(int frame) const { return Norm(At(offset_, frame)); }
  // How far the body turns in a frame.
  float Turn(int frame) const {
    return frame > 0 ? AngleBetween(At(facing_, frame - 1), At(facing_, frame)) : 0;
  }

 private:
  static Vec3 At(const Track& track, int frame) { return track[static_cast<std::size_t>(frame)]; }

  Track facing_, offset_;
};

// The turns that bring a body back, frame by frame. Radians.
class TurnBack {
 public:
  TurnBack(const FacingOptions& options, const Timing& timing)
      : patience_(Float(timing.Frames(options.patience_seconds))),
        settled_share_(Float(options.settled_share)),
        fastest_(MostInAFrame(options.fastest_degrees, timing)),
        gain_(Float(1 / timing.Frames(options.stop_seconds))),
        start_(fastest_ / Float(timing.Frames(options.start_seconds))) {}

  // Adds a frame in which the body is `away` without the correction so far, and may be `most`.
  void Watch(float away, float most, bool near) {
    const float left = Wrapped(away - turned_), angle = std::abs(left);
    if (near || angle < settled_share_ * most) turns_ = false;
    away_frames_ = near || angle <= most ? 0 : away_frames_ + (most > 0 ? angle / most : 1);
    // A body that has turned by itself meanwhile has been turned too far.
    const bool too_far = !near && left * turned_ < 0 && angle > settled_share_ * most;
    if (away_frames_ > patience_ || too_far) turns_ = true;
  }

  // The correction of that frame. `own`: how far the body turns by itself.
  float Correction(float away, float own) {
    const float left = Wrapped(away - turned_);
    const float missing = std::clamp(left * gain_, -fastest_, fastest_) - own;
    const float wanted = turns_ && missing * left > 0 ? missing : 0;
    speed_ += std::clamp(wanted - speed_, -start_, start_);
    turned_ += speed_;
    return turned_;
  }

 private:
  const float patience_, settled_share_, fastest_, gain_, start_;
  float away_frames_ = 0;  // those in which it is twice as far away as it may count twice
  bool turns_ = false;
  float speed_ = 0, turned_ = 0;
};

}  // namespace

std::vector<float> DegreesAway(const motion::Skeleton& skeleton, const body::Body& body,
                               const motion::Poses& leader, const motion::Poses& follower,
                               double sigma_frames) {
  if (!skeleton.hips || !body.shoulders) return {};
  View view(skeleton, body, leader, follower);
  view.Smooth(sigma_frames);
  std::vector<float> degrees;
  for (int t = 0; t < follower.frame_count(); ++t) {
    degrees.push_back(view.Away(t) * Float(base::kDegreesPerRadian));
  }
  return degrees;
}

void FaceLeader(const motion::Skeleton& skeleton, const body::Body& body,
                const motion::Poses& leader, const std::vector<float>& most_away,
                const FacingOptions& options, const Timing& timing, motion::Poses* follower) {
  if (!skeleton.hips || !body.shoulders) return;
  const int frames = follower->frame_count();
  const auto most = [&](int t) {
    return Float(base::kRadiansPerDegree) * most_away[static_cast<std::size_t>(t)];
  };
  View view(skeleton, body, leader, *follower);
  if (!view.IsEverAway(most)) return;
  view.Smooth(timing.Frames(options.sigma_seconds));
  TurnBack back(options, timing);
  for (int t = 0; t < frames; ++t) {
    const float away = view.Away(t);
    back.Watch(away, most(t), view.Metres(t) < Float(options.near_metres));
    if (t < timing.settled) continue;
    const double turn = double{back.Correction(away, view.Turn(t))};
    if (turn == 0) continue;
    const Vec3 pivot = follower->at(t, skeleton.root);
    for (Vec3& joint : (*follower)[t]) joint = pivot + RotateY(joint - pivot, turn);
  }
}

}  // namespace duet::cleanup
