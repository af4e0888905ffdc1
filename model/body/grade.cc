#include "model/body/grade.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/motion/capsules.h"

namespace duet::body {
namespace {

using motion::Vec3;
using Pose = absl::Span<const Vec3>;

Vec3 At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

struct Segment {
  Vec3 from, to;
};

Segment Trunk(const motion::Skeleton& skeleton, const Body& body, Pose pose) {
  return {Lerp(At(pose, skeleton.hips->left), At(pose, skeleton.hips->right), 0.5f),
          At(pose, *body.chest)};
}

double TrunkOverlap(const motion::Skeleton& skeleton, const Body& body, Pose leader,
                    Pose follower) {
  const Segment a = Trunk(skeleton, body, leader), b = Trunk(skeleton, body, follower);
  return std::max(0.0, kTrunkMetres - motion::SegmentDistance(a.from, a.to, b.from, b.to));
}

double HeadOverlap(const Neck& neck, Pose leader, Pose follower) {
  return std::max(0.0,
                  kHeadMetres - double{Distance(At(leader, neck.head), At(follower, neck.head))});
}

}  // namespace

double TwistDegrees(const motion::Skeleton& skeleton, const Body& body, Pose pose) {
  const Segment trunk = Trunk(skeleton, body, pose);
  const Vec3 along = trunk.to - trunk.from;
  const float height = Norm(along);
  if (height == 0) return 0;
  const Vec3 up = along / height;
  const auto across = [&](const motion::JointPair& pair) {
    const Vec3 way = At(pose, pair.left) - At(pose, pair.right);
    return way - up * Dot(way, up);
  };
  const Vec3 hips = across(*skeleton.hips), shoulders = across(*body.shoulders);
  return base::kDegreesPerRadian *
         std::atan2(double{Dot(Cross(hips, shoulders), up)}, double{Dot(hips, shoulders)});
}

bool PairMeter::CanMeasure(const motion::Skeleton& skeleton, const Body& body) {
  return skeleton.hips && skeleton.feet && body.shoulders && body.chest;
}

PairMeter::Feet PairMeter::FeetOf(Pose pose) const {
  return {At(pose, skeleton_.feet->left), At(pose, skeleton_.feet->right)};
}

double PairMeter::SlowerFoot(const Feet& before, const Feet& now) const {
  return frame_rate_hz_ *
         double{std::min(Distance(before.left, now.left), Distance(before.right, now.right))};
}

FrameMeasures PairMeter::Add(Pose leader, Pose follower) {
  const Feet leader_feet = FeetOf(leader), follower_feet = FeetOf(follower);
  FrameMeasures frame;
  frame.twist_degrees = std::abs(TwistDegrees(skeleton_, body_, follower));
  if (follower_feet_) {
    frame.skate = SlowerFoot(*follower_feet_, follower_feet);
    frame.leader_skate = SlowerFoot(*leader_feet_, leader_feet);
  }
  frame.trunk_overlap = TrunkOverlap(skeleton_, body_, leader, follower);
  if (body_.neck) frame.head_overlap = HeadOverlap(*body_.neck, leader, follower);
  leader_feet_ = leader_feet;
  follower_feet_ = follower_feet;
  return frame;
}

void GradeSum::Add(const FrameMeasures& frame) {
  const int index = frames_++;
  twisted_ += frame.twisted();
  skating_ += frame.skates();
  leader_skating_ += frame.leader_skates();
  overlapping_ += frame.overlaps();
  if (!frame.twisted() && !frame.overlaps()) return;
  if (!bad_runs_.empty() && bad_runs_.back().first + bad_runs_.back().count == index) {
    ++bad_runs_.back().count;
  } else if (bad_runs_.size() < kMostRuns) {
    bad_runs_.push_back({index, 1});
  }
}

Grade GradeSum::Get() const {
  const double frames = frames_;
  return {twisted_ / frames, skating_ / frames, leader_skating_ / frames, overlapping_ / frames,
          bad_runs_};
}

}  // namespace duet::body
