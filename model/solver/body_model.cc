#include "model/solver/body_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/status/status.h"
#include "model/base/median.h"
#include "model/motion/limb_lengths.h"
#include "model/solver/geometry.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// Of length 1; upwards for a vector of no length, so that a body has axes in any pose.
Vec3 AxisOf(Vec3 v) {
  const float length = Norm(v);
  return length > 0 ? v / length : Vec3{0, 1, 0};
}

float MedianDistance(const motion::Poses& person, int a, int b) {
  std::vector<float> lengths;
  lengths.reserve(static_cast<std::size_t>(person.frame_count()));
  for (int t = 0; t < person.frame_count(); ++t) {
    lengths.push_back(Distance(person.at(t, a), person.at(t, b)));
  }
  return base::Median(std::move(lengths));
}

std::vector<int> PathToRoot(const std::vector<int>& parents, int joint) {
  std::vector<int> path;
  for (; joint >= 0; joint = parents[static_cast<std::size_t>(joint)]) path.push_back(joint);
  return path;
}

// The first joint on the path from `a` to the root that is also on that of `b`.
int CommonAncestor(const std::vector<int>& parents, int a, int b) {
  const std::vector<int> path = PathToRoot(parents, b);
  for (const int joint : PathToRoot(parents, a)) {
    if (Contains(path, joint)) return joint;
  }
  return a;  // not reached: all paths end at the root
}

// The joints from `joint` towards the root, before `stop`.
void AppendPath(const std::vector<int>& parents, int joint, int stop, std::vector<int>* path) {
  for (; joint >= 0 && joint != stop; joint = parents[static_cast<std::size_t>(joint)]) {
    if (!Contains(*path, joint)) path->push_back(joint);
  }
}

}  // namespace

absl::StatusOr<BodyModel> BodyModel::Measure(const motion::Skeleton& skeleton,
                                             const motion::Poses& person) {
  const body::Body parts = body::FindBody(skeleton);
  if (!skeleton.hips || parts.legs.size() != 2 || !parts.chest || !parts.shoulders) {
    return absl::InvalidArgumentError(
        "skeleton: expected hips, feet, two legs and two arms of two bones, and a trunk between "
        "them, got a skeleton without one of these");
  }
  if (person.empty()) return absl::InvalidArgumentError("frames: expected at least 1, got 0");
  BodyModel model;
  model.legs_ = parts.legs;
  model.arms_ = parts.arms;
  model.hips_ = *skeleton.hips;
  model.shoulders_ = *parts.shoulders;
  model.chest_ = *parts.chest;
  const std::vector<int> parents = skeleton.Parents();
  const int pelvis = CommonAncestor(parents, model.hips_.left, model.hips_.right);
  std::vector<int> joints = {pelvis};
  AppendPath(parents, model.hips_.left, pelvis, &joints);
  AppendPath(parents, model.hips_.right, pelvis, &joints);
  model.pelvis_ = model.MeasureRigid(joints, -1, model.hips_.left, model.hips_.right, person);
  joints.clear();
  AppendPath(parents, model.shoulders_.left, model.chest_, &joints);
  AppendPath(parents, model.shoulders_.right, model.chest_, &joints);
  model.girdle_ = model.MeasureRigid(joints, model.chest_, model.shoulders_.left,
                                     model.shoulders_.right, person);
  // Outwards from the pelvis: bones between it and the root point the other way.
  std::vector<int> reached = {pelvis};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const motion::Bone& bone : skeleton.bones) {
      if (bone.parent != reached[i] && bone.child != reached[i]) continue;
      const int to = bone.parent == reached[i] ? bone.child : bone.parent;
      if (Contains(reached, to)) continue;
      reached.push_back(to);
      if (Contains(model.pelvis_.joints, to) || Contains(joints, to)) continue;
      model.segments_.push_back({reached[i], to, MedianDistance(person, reached[i], to)});
    }
  }
  return model;
}

BodyModel::Axes BodyModel::AxesOf(int left, int right, absl::Span<const Vec3> pose) const {
  const Vec3 hips = (JointAt(pose, hips_.left) + JointAt(pose, hips_.right)) / 2;
  const Vec3 trunk = AxisOf(JointAt(pose, chest_) - hips);
  Axes axes;
  axes.across = AxisOf(JointAt(pose, left) - JointAt(pose, right));
  axes.up = AxisOf(trunk - axes.across * Dot(trunk, axes.across));
  axes.forward = Cross(axes.across, axes.up);
  return axes;
}

// Places relative to joint `origin`, or to the middle of the joints if it is -1.
BodyModel::Rigid BodyModel::MeasureRigid(const std::vector<int>& joints, int origin, int left,
                                         int right, const motion::Poses& person) const {
  std::vector<std::vector<float>> x(joints.size()), y(joints.size()), z(joints.size());
  for (auto* const coordinate : {&x, &y, &z}) {
    for (std::vector<float>& values : *coordinate) {
      values.reserve(static_cast<std::size_t>(person.frame_count()));
    }
  }
  for (int t = 0; t < person.frame_count(); ++t) {
    const Axes axes = AxesOf(left, right, person[t]);
    Vec3 middle;
    for (const int joint : joints)
      middle += person.at(t, joint) / static_cast<float>(joints.size());
    const Vec3 from = origin < 0 ? middle : person.at(t, origin);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const Vec3 place = person.at(t, joints[i]) - from;
      x[i].push_back(Dot(place, axes.across));
      y[i].push_back(Dot(place, axes.up));
      z[i].push_back(Dot(place, axes.forward));
    }
  }
  Rigid rigid{joints, {}};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    rigid.places.push_back({base::Median(std::move(x[i])), base::Median(std::move(y[i])),
                            base::Median(std::move(z[i]))});
  }
  return rigid;
}

void BodyModel::FitLimb(const body::Limb& limb, absl::Span<const Vec3> old,
                        absl::Span<Vec3> pose) const {
  const float length = body::LengthOf(limb, old);
  if (length <= 0) return;
  // A share of the length, not metres: a knee keeps its angle if the bones get another length.
  const float stretch = Distance(JointAt(old, limb.end), JointAt(old, limb.upper)) / length;
  const Vec3 upper = JointAt(pose, limb.upper);
  body::ReachBent(
      limb, upper + AxisOf(JointAt(old, limb.end) - upper) * (stretch * body::LengthOf(limb, pose)),
      body::BendOf(limb, old), pose);
}

void BodyModel::Fit(absl::Span<Vec3> pose) const {
  const std::vector<Vec3> old(pose.begin(), pose.end());
  const auto place = [&](const Rigid& rigid, const Axes& axes, Vec3 from) {
    for (std::size_t i = 0; i < rigid.joints.size(); ++i) {
      const Vec3 at = rigid.places[i];
      pose[static_cast<std::size_t>(rigid.joints[i])] =
          from + axes.across * at.x + axes.up * at.y + axes.forward * at.z;
    }
  };
  Vec3 middle;
  for (const int joint : pelvis_.joints) {
    middle += JointAt(old, joint) / static_cast<float>(pelvis_.joints.size());
  }
  place(pelvis_, AxesOf(hips_.left, hips_.right, old), middle);
  bool shoulders = false;
  const auto place_shoulders = [&] {
    place(girdle_, AxesOf(shoulders_.left, shoulders_.right, old), JointAt(pose, chest_));
    shoulders = true;
  };
  if (Contains(pelvis_.joints, chest_)) place_shoulders();
  for (const Segment& segment : segments_) {
    // Towards the captured joint, not parallel to the captured bone: errors do not add up.
    const Vec3 direction = AxisOf(JointAt(old, segment.to) - JointAt(pose, segment.from));
    pose[static_cast<std::size_t>(segment.to)] =
        JointAt(pose, segment.from) + direction * segment.length;
    if (!shoulders && segment.to == chest_) place_shoulders();
  }
  for (const std::vector<body::Limb>* limbs : {&legs_, &arms_}) {
    for (const body::Limb& limb : *limbs) FitLimb(limb, old, pose);
  }
}

void BodyModel::FitAboveFeet(absl::Span<Vec3> pose) const {
  std::vector<Vec3> feet;
  for (const body::Limb& leg : legs_) feet.push_back(JointAt(pose, leg.end));
  Fit(pose);
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const Vec3 facing = body::Facing(hips_, pose);
    body::Reach(legs_[i], feet[i], facing, pose);
  }
}

void BodyModel::Scale(float factor) {
  for (Rigid* rigid : {&pelvis_, &girdle_}) {
    for (Vec3& place : rigid->places) place = place * factor;
  }
  for (Segment& segment : segments_) segment.length *= factor;
}

float BodyModel::LegLength(int leg) const {
  const body::Limb& limb = legs_[static_cast<std::size_t>(leg)];
  float length = 0;
  for (const Segment& segment : segments_) {
    if (segment.to == limb.middle || segment.to == limb.end) length += segment.length;
  }
  return length;
}

double BodyModel::BoneNoise(const motion::Skeleton& skeleton, const motion::Poses& person) {
  const std::vector<float> medians = motion::MedianBoneLengths(skeleton, person);
  double sum = 0;
  for (std::size_t i = 0; i < skeleton.bones.size(); ++i) {
    double squares = 0;
    for (int t = 0; t < person.frame_count(); ++t) {
      const motion::Bone& bone = skeleton.bones[i];
      const double error =
          Distance(person.at(t, bone.parent), person.at(t, bone.child)) - medians[i];
      squares += error * error;
    }
    sum += std::sqrt(squares / person.frame_count());
  }
  return sum / static_cast<double>(skeleton.bones.size());
}

}  // namespace duet::solver
