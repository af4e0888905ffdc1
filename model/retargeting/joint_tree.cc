#include "model/retargeting/joint_tree.h"

#include <cstddef>

#include "model/base/index.h"

namespace duet::retargeting {
namespace {

constexpr Vec3d kLeft = {1, 0, 0}, kRight = {-1, 0, 0}, kUp = {0, 1, 0}, kDown = {0, -1, 0};

using base::Index;

class StraightFigure {
 public:
  StraightFigure(const JointTree& tree, const Landmarks& landmarks)
      : tree_(tree), landmarks_(landmarks), places_(tree.names.size()) {}

  std::vector<motion::Vec3> Build() {
    for (std::size_t j = 0; j < places_.size(); ++j) {
      if (tree_.parents[j] >= 0) places_[j] = PlaceAfterParent(j, kUp);
    }
    const int base = Base();
    if (base >= 0) {
      const Vec3d origin = places_[Index(base)];
      for (Vec3d& place : places_) place = place - origin;
      if (landmarks_.hips) PlaceLimbs(*landmarks_.hips, base, kDown, kDown, kDown);
    }
    if (landmarks_.shoulders) {
      const motion::JointPair& shoulders = *landmarks_.shoulders;
      const int chest = CommonAncestor(tree_, shoulders.left, shoulders.right);
      if (chest >= 0) PlaceLimbs(shoulders, chest, kUp, kLeft, kRight);
    }
    std::vector<motion::Vec3> straight;
    straight.reserve(places_.size());
    for (const Vec3d& place : places_) straight.push_back(ToFloat(place));
    return straight;
  }

 private:
  Vec3d PlaceAfterParent(std::size_t joint, Vec3d direction) const {
    return places_[Index(tree_.parents[joint])] + direction * Norm(tree_.offsets[joint]);
  }

  // The joint at which legs and trunk separate; -1 without hips.
  int Base() const {
    if (!landmarks_.hips) return -1;
    const int pelvis = CommonAncestor(tree_, landmarks_.hips->left, landmarks_.hips->right);
    const int top = landmarks_.shoulders ? landmarks_.shoulders->left : landmarks_.head;
    if (pelvis < 0 || top < 0) return pelvis;
    return CommonAncestor(tree_, pelvis, top);
  }

  Vec3d Offset(int ancestor, int joint) const {
    Vec3d sum;
    for (; joint != ancestor; joint = tree_.parents[Index(joint)]) {
      sum += tree_.offsets[Index(joint)];
    }
    return sum;
  }

  // Places both limbs of a pair whose middle is in the direction of `middle` from `ancestor`.
  void PlaceLimbs(motion::JointPair starts, int ancestor, Vec3d middle, Vec3d left, Vec3d right) {
    const Vec3d to_left = Offset(ancestor, starts.left), to_right = Offset(ancestor, starts.right);
    const Vec3d centre = places_[Index(ancestor)] + middle * (Norm(to_left + to_right) / 2);
    const double half_width = Norm(to_left - to_right) / 2;
    PlaceLimb(starts.left, centre + kLeft * half_width, left);
    PlaceLimb(starts.right, centre + kRight * half_width, right);
  }

  void PlaceLimb(int start, Vec3d at, Vec3d direction) {
    places_[Index(start)] = at;
    for (std::size_t j = Index(start) + 1; j < places_.size(); ++j) {
      if (!IsAtOrBelow(tree_, static_cast<int>(j), start)) continue;
      places_[j] = PlaceAfterParent(j, direction);
    }
  }

  const JointTree& tree_;
  const Landmarks& landmarks_;
  std::vector<Vec3d> places_;  // [names]
};

}  // namespace

bool IsAtOrBelow(const JointTree& tree, int joint, int ancestor) {
  while (joint > ancestor) joint = tree.parents[Index(joint)];
  return joint == ancestor;
}

int CommonAncestor(const JointTree& tree, int a, int b) {
  // Parents precede their children, so the later of two different joints is not an ancestor.
  while (a != b && a >= 0 && b >= 0) {
    int& later = a > b ? a : b;
    later = tree.parents[Index(later)];
  }
  return a == b ? a : -1;
}

std::vector<motion::Vec3> PullStraight(const JointTree& tree, const Landmarks& landmarks) {
  return StraightFigure(tree, landmarks).Build();
}

}  // namespace duet::retargeting
