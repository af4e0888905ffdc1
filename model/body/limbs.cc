#include "model/body/limbs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"

namespace duet::body {
namespace {

using motion::Vec3;

// The neighbours of each joint of a tree.
struct Tree {
  explicit Tree(const motion::Skeleton& skeleton)
      : parents(skeleton.Parents()), children(parents.size()) {
    for (const motion::Bone& bone : skeleton.bones) {
      children[static_cast<std::size_t>(bone.parent)].push_back(bone.child);
    }
  }
  int Parent(int joint) const { return parents[static_cast<std::size_t>(joint)]; }
  const std::vector<int>& Children(int joint) const {
    return children[static_cast<std::size_t>(joint)];
  }
  // The joint and all joints below it.
  std::vector<int> Branch(int joint) const {
    std::vector<int> branch = {joint};
    for (std::size_t i = 0; i < branch.size(); ++i) {
      const std::vector<int>& next = Children(branch[i]);
      branch.insert(branch.end(), next.begin(), next.end());
    }
    return branch;
  }
  std::vector<int> parents;
  std::vector<std::vector<int>> children;
};

bool Contains(const std::vector<int>& joints, int joint) {
  return std::find(joints.begin(), joints.end(), joint) != joints.end();
}

std::optional<Limb> LimbThatEndsAt(const Tree& tree, int end) {
  const int middle = tree.Parent(end);
  const int upper = middle < 0 ? -1 : tree.Parent(middle);
  if (upper < 0) return std::nullopt;
  std::vector<int> beyond = tree.Branch(end);
  beyond.erase(beyond.begin());
  return Limb{upper, middle, end, beyond};
}

std::vector<Limb> FindLegs(const Tree& tree, const motion::JointPair& feet) {
  const std::optional<Limb> left = LimbThatEndsAt(tree, feet.left);
  const std::optional<Limb> right = LimbThatEndsAt(tree, feet.right);
  if (!left || !right || left->middle == right->middle) return {};
  return {*left, *right};
}

// The nearest common ancestor of both hips.
int Pelvis(const Tree& tree, const motion::JointPair& hips) {
  int joint = hips.left;
  while (!Contains(tree.Branch(joint), hips.right)) joint = tree.Parent(joint);
  return joint;
}

// Visits the joints outwards from the pelvis, nearest first, except the legs.
std::optional<int> FindChest(const Tree& tree, const motion::JointPair& hips) {
  const int pelvis = Pelvis(tree, hips);
  std::vector<int> seen = {pelvis};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::vector<int> next = tree.Children(seen[i]);
    if (tree.Parent(seen[i]) >= 0) next.push_back(tree.Parent(seen[i]));
    if (seen[i] != pelvis && next.size() >= 3) return seen[i];
    for (const int joint : next) {
      const std::vector<int> branch = tree.Branch(joint);
      const bool is_leg = joint != tree.Parent(seen[i]) &&
                          (Contains(branch, hips.left) || Contains(branch, hips.right));
      if (!is_leg && !Contains(seen, joint)) seen.push_back(joint);
    }
  }
  return std::nullopt;
}

// Whether the name of a joint contains `word`.
bool IsNamed(const motion::Skeleton& skeleton, int joint, const char* word) {
  const std::string& name = skeleton.joint_names[static_cast<std::size_t>(joint)];
  return absl::StrContains(absl::AsciiStrToLower(name), word);
}

// The first joint of a branch with "head" in its name, the nearest to the body.
std::optional<int> FindHead(const motion::Skeleton& skeleton, const std::vector<int>& branch) {
  const auto head = std::find_if(branch.begin(), branch.end(),
                                 [&](int joint) { return IsNamed(skeleton, joint, "head"); });
  if (head == branch.end()) return std::nullopt;
  return *head;
}

std::optional<Neck> FindNeck(const motion::Skeleton& skeleton, const Tree& tree, int chest) {
  for (const int first : tree.Children(chest)) {
    const std::optional<int> head = FindHead(skeleton, tree.Branch(first));
    if (head) return Neck{tree.Parent(*head), *head, tree.Branch(*head)};
  }
  return std::nullopt;
}

std::vector<Limb> FindArms(const motion::Skeleton& skeleton, const Tree& tree, int chest,
                           const motion::JointPair& hips) {
  std::vector<Limb> arms;
  for (const int first : tree.Children(chest)) {
    const std::vector<int> branch = tree.Branch(first);
    if (Contains(branch, hips.left) || FindHead(skeleton, branch)) continue;
    int joints = 1, end = first;
    while (tree.Children(end).size() == 1 && !IsNamed(skeleton, end, "wrist")) {
      end = tree.Children(end)[0];
      ++joints;
    }
    if (joints >= 3) arms.push_back(*LimbThatEndsAt(tree, end));
  }
  return arms;
}

// Whether the name of a joint of the limb contains `side`.
bool IsOn(const motion::Skeleton& skeleton, const Limb& limb, const char* side) {
  const int joints[] = {limb.upper, limb.middle, limb.end};
  return std::any_of(std::begin(joints), std::end(joints),
                     [&](int joint) { return IsNamed(skeleton, joint, side); });
}

std::optional<motion::JointPair> FindShoulders(const motion::Skeleton& skeleton,
                                               const std::vector<Limb>& arms) {
  if (arms.size() != 2) return std::nullopt;
  for (const int left : {0, 1}) {
    const Limb &a = arms[static_cast<std::size_t>(left)],
               &b = arms[static_cast<std::size_t>(1 - left)];
    if (IsOn(skeleton, a, "left") && IsOn(skeleton, b, "right"))
      return motion::JointPair{a.upper, b.upper};
  }
  return std::nullopt;
}

motion::BodyPart PartOf(const char* name, const Limb& limb) {
  motion::BodyPart part{name, {limb.upper, limb.middle, limb.end}};
  part.joints.insert(part.joints.end(), limb.beyond.begin(), limb.beyond.end());
  return part;
}

Vec3 Across(Vec3 v, Vec3 unit) { return v - unit * Dot(v, unit); }

Vec3 Unit(Vec3 v) { return v / Norm(v); }

// A direction perpendicular to `along`.
Vec3 AnyAcross(Vec3 along) {
  return Unit(Across(std::abs(along.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, along));
}

}  // namespace

Body FindBody(const motion::Skeleton& skeleton) {
  const Tree tree(skeleton);
  Body body;
  if (skeleton.feet) body.legs = FindLegs(tree, *skeleton.feet);
  if (!skeleton.hips) return body;
  body.chest = FindChest(tree, *skeleton.hips);
  if (!body.chest) return body;
  body.arms = FindArms(skeleton, tree, *body.chest, *skeleton.hips);
  body.shoulders = FindShoulders(skeleton, body.arms);
  body.neck = FindNeck(skeleton, tree, *body.chest);
  return body;
}

std::vector<motion::BodyPart> LimbParts(const Body& body) {
  std::vector<motion::BodyPart> parts;
  for (const Limb& arm : body.arms) parts.push_back(PartOf("arm", arm));
  for (const Limb& leg : body.legs) parts.push_back(PartOf("leg", leg));
  return parts;
}

float LengthOf(const Limb& limb, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  return Distance(at(limb.upper), at(limb.middle)) + Distance(at(limb.middle), at(limb.end));
}

Vec3 BendOf(const Limb& limb, absl::Span<const Vec3> pose) {
  const Vec3 upper = pose[static_cast<std::size_t>(limb.upper)];
  const Vec3 way = pose[static_cast<std::size_t>(limb.end)] - upper;
  const Vec3 middle = pose[static_cast<std::size_t>(limb.middle)] - upper;
  return Norm(way) > 0 ? Across(middle, Unit(way)) : middle;
}

void ReachBent(const Limb& limb, Vec3 target, Vec3 bend, absl::Span<Vec3> pose) {
  // A straight or completely folded limb would have no bend direction.
  constexpr float kLongest = 0.999f, kShortest = 0.1f;
  const Vec3 upper = pose[static_cast<std::size_t>(limb.upper)];
  Vec3& middle = pose[static_cast<std::size_t>(limb.middle)];
  Vec3& end = pose[static_cast<std::size_t>(limb.end)];
  const float thigh = Distance(upper, middle), shin = Distance(middle, end);
  if (thigh == 0 || shin == 0 || target == upper) return;
  const float now = Distance(upper, end);
  const float longest = std::max(now, kLongest * (thigh + shin));
  const float shortest = std::max(std::abs(thigh - shin), kShortest * (thigh + shin));
  const float reach =
      std::clamp(Distance(upper, target), std::min(now, shortest), std::max(now, longest));
  const Vec3 along = Unit(target - upper);
  bend = Across(bend, along);
  bend = Norm(bend) > 1e-6f ? Unit(bend) : AnyAcross(along);
  const float cosine =
      std::clamp((thigh * thigh + reach * reach - shin * shin) / (2 * thigh * reach), -1.0f, 1.0f);
  const Vec3 to_middle = along * cosine + bend * std::sqrt(1 - cosine * cosine);
  middle = upper + Unit(to_middle) * thigh;
  const Vec3 new_end = middle + Unit(upper + along * reach - middle) * shin;
  for (const int joint : limb.beyond) pose[static_cast<std::size_t>(joint)] += new_end - end;
  end = new_end;
}

void Reach(const Limb& limb, Vec3 target, Vec3 forward, absl::Span<Vec3> pose) {
  // Metres. A smaller bend has no direction.
  constexpr float kClearBend = 0.02f;
  const Vec3 upper = pose[static_cast<std::size_t>(limb.upper)];
  const float moved = Distance(target, pose[static_cast<std::size_t>(limb.end)]);
  if (moved == 0 || target == upper) return;
  const Vec3 along = Unit(target - upper);
  Vec3 bend = Across(pose[static_cast<std::size_t>(limb.middle)] - upper, along);
  const float unclear = std::max(0.0f, kClearBend - Norm(bend));
  bend += Across(forward, along) * (unclear * std::min(1.0f, moved / kClearBend));
  ReachBent(limb, target, bend, pose);
}

Vec3 Facing(const motion::JointPair& hips, absl::Span<const Vec3> pose) {
  const Vec3 across =
      pose[static_cast<std::size_t>(hips.right)] - pose[static_cast<std::size_t>(hips.left)];
  const Vec3 facing = Cross(Vec3{0, 1, 0}, across);
  const float length = Norm(facing);
  return length > 0 ? facing / length : Vec3{0, 0, 1};
}

}  // namespace duet::body
