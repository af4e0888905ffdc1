#include "model/formats/research/body_joints.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace duet::formats::research {
namespace {

using motion::Vec3;

// Shares of the way from the middle of the hip joints to the neck, along the trunk, of a person
// whose pelvis is not known; and of the way from the pelvis to the neck.
constexpr float kPelvisHeight = 0.15f;
constexpr std::array<float, 3> kSpineHeights = {0.21f, 0.48f, 0.58f};
// The ball of the foot: metres ahead of the ankle and beyond it, at a right angle to the shin.
constexpr float kFootAhead = 0.13f, kFootBelow = 0.06f;

// One person's joints by name.
class Joints {
 public:
  explicit Joints(const motion::Clip& person) : names_(person.joint_names) {}

  // The first of these joints that the person has.
  std::optional<int> First(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const auto at = std::find(names_.begin(), names_.end(), name);
      if (at != names_.end()) return static_cast<int>(at - names_.begin());
    }
    return std::nullopt;
  }

  // The same for a joint that must be there.
  int Need(std::initializer_list<const char*> names) {
    const std::optional<int> joint = First(names);
    if (!joint) missing_.push_back(*names.begin());
    return joint.value_or(0);
  }

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  const std::vector<std::string>& names_;
  std::vector<std::string> missing_;
};

struct Side {
  int shoulder = 0, elbow = 0, wrist = 0, hip = 0, knee = 0, ankle = 0;
  std::optional<int> toe;
};

struct Anatomy {
  std::optional<int> pelvis;
  std::vector<int> trunk;  // between pelvis and neck, upwards
  int neck = 0, head = 0;
  Side left, right;
};

// The place at a share of the length of a path.
Vec3 Along(const std::vector<Vec3>& path, float share) {
  float length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += Distance(path[i - 1], path[i]);
  float left = share * length;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const float step = Distance(path[i - 1], path[i]);
    if (left <= step && step > 0) return motion::Lerp(path[i - 1], path[i], left / step);
    left -= step;
  }
  return path.back();
}

Vec3 UnitOr(Vec3 a, Vec3 fallback) {
  const float norm = Norm(a);
  return norm > 1e-6f ? a / norm : fallback;
}

Anatomy Find(Joints* joints) {
  Anatomy anatomy;
  const auto side = [joints](bool left) {
    const auto need = [&](const char* one, const char* other) {
      const std::string first = absl::StrCat(left ? "left_" : "right_", one);
      const std::string second = absl::StrCat(left ? "left_" : "right_", other);
      return joints->Need({first.c_str(), second.c_str()});
    };
    Side found;
    found.shoulder = need("shoulder", "shoulder");
    found.elbow = need("elbow", "elbow");
    found.wrist = need("wrist", "hand");
    found.hip = need("hip", "hip");
    found.knee = need("knee", "knee");
    found.ankle = need("ankle", "foot");
    found.toe = joints->First({left ? "left_toe" : "right_toe"});
    return found;
  };
  anatomy.pelvis = joints->First({"hips", "pelvis"});
  anatomy.neck = joints->Need({"neck"});
  anatomy.head = joints->Need({"head"});
  for (const char* name : {"spine", "torso", "chest"}) {
    const std::optional<int> joint = joints->First({name});
    if (joint) anatomy.trunk.push_back(*joint);
  }
  anatomy.left = side(true);
  anatomy.right = side(false);
  return anatomy;
}

Vec3 Toe(const Side& side, absl::Span<const Vec3> pose, Vec3 ahead) {
  const Vec3 ankle = pose[static_cast<std::size_t>(side.ankle)];
  if (side.toe) return pose[static_cast<std::size_t>(*side.toe)];
  const Vec3 shin = UnitOr(ankle - pose[static_cast<std::size_t>(side.knee)], {0, -1, 0});
  const Vec3 flat = UnitOr(ahead - shin * Dot(ahead, shin), ahead);
  return ankle + flat * kFootAhead + shin * kFootBelow;
}

std::vector<Vec3> BodyPose(const Anatomy& anatomy, absl::Span<const Vec3> pose) {
  const auto at = [&pose](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  std::vector<Vec3> body(kBodyJoints);
  const Vec3 hips = (at(anatomy.left.hip) + at(anatomy.right.hip)) / 2;
  std::vector<Vec3> path = {hips};
  for (int joint : anatomy.trunk) path.push_back(at(joint));
  path.push_back(at(anatomy.neck));
  if (anatomy.pelvis) {
    path.front() = at(*anatomy.pelvis);
  } else {
    path.insert(path.begin() + 1, Along(path, kPelvisHeight));
    path.erase(path.begin());
  }
  body[kPelvis] = path.front();
  body[kSpine1] = Along(path, kSpineHeights[0]);
  body[kSpine2] = Along(path, kSpineHeights[1]);
  body[kSpine3] = Along(path, kSpineHeights[2]);
  body[kNeck] = at(anatomy.neck);
  body[kHead] = (at(anatomy.neck) + at(anatomy.head)) / 2;
  const Vec3 across = at(anatomy.right.hip) - at(anatomy.left.hip);
  const Vec3 ahead = UnitOr(Cross({0, 1, 0}, across), {0, 0, 1});
  const auto fill = [&](const Side& side, int first) {  // `first` is 0 on the left, 1 on the right
    const auto set = [&](int left_joint, Vec3 place) {
      body[static_cast<std::size_t>(left_joint + first)] = place;
    };
    set(kLeftHip, at(side.hip));
    set(kLeftKnee, at(side.knee));
    set(kLeftAnkle, at(side.ankle));
    set(kLeftFoot, Toe(side, pose, ahead));
    set(kLeftShoulder, at(side.shoulder));
    set(kLeftElbow, at(side.elbow));
    set(kLeftWrist, at(side.wrist));
    set(kLeftCollar, (body[kNeck] + body[kSpine3]) * 0.25f + at(side.shoulder) * 0.5f);
  };
  fill(anatomy.left, 0);
  fill(anatomy.right, 1);
  return body;
}

}  // namespace

const std::vector<int>& BodyParents() {
  static const auto* const kParents = new std::vector<int>{-1, 0, 0, 0, 1,  2,  3,  4,  5,  6,  7,
                                                           8,  9, 9, 9, 12, 13, 14, 16, 17, 18, 19};
  return *kParents;
}

const motion::Skeleton& BodySkeleton() {
  static const auto* const kSkeleton = [] {
    auto* const skeleton = new motion::Skeleton;
    skeleton->joint_names = {"pelvis",        "left_hip",       "right_hip",    "spine1",
                             "left_knee",     "right_knee",     "spine2",       "left_ankle",
                             "right_ankle",   "spine3",         "left_foot",    "right_foot",
                             "neck",          "left_collar",    "right_collar", "head",
                             "left_shoulder", "right_shoulder", "left_elbow",   "right_elbow",
                             "left_wrist",    "right_wrist"};
    for (int joint = 1; joint < kBodyJoints; ++joint) {
      skeleton->bones.push_back({BodyParents()[static_cast<std::size_t>(joint)], joint});
    }
    skeleton->hips = motion::JointPair{kLeftHip, kRightHip};
    skeleton->feet = motion::JointPair{kLeftAnkle, kRightAnkle};
    return skeleton;
  }();
  return *kSkeleton;
}

const motion::Skeleton& DetailedSkeleton() {
  static const auto* const kSkeleton = [] {
    auto* const skeleton = new motion::Skeleton;
    std::vector<std::string>& names = skeleton->joint_names;
    names = {"hips", "spine", "chest", "neck", "head"};
    for (int joint = 1; joint < 5; ++joint) skeleton->bones.push_back({joint - 1, joint});
    const auto add = [skeleton, &names](int parent, const char* side,
                                        std::initializer_list<const char*> limb) {
      const int first = skeleton->joint_count();
      for (const char* name : limb) {
        skeleton->bones.push_back({parent, skeleton->joint_count()});
        parent = skeleton->joint_count();
        names.push_back(absl::StrCat(side, "_", name));
      }
      return first;
    };
    add(2, "left", {"shoulder", "elbow", "wrist"});
    add(2, "right", {"shoulder", "elbow", "wrist"});
    const int left = add(0, "left", {"hip", "knee", "ankle", "toe"});
    const int right = add(0, "right", {"hip", "knee", "ankle", "toe"});
    skeleton->hips = motion::JointPair{left, right};
    skeleton->feet = motion::JointPair{left + 2, right + 2};
    return skeleton;
  }();
  return *kSkeleton;
}

bool HasBodyJoints(const std::vector<std::string>& joint_names) {
  const std::vector<std::string>& body = BodySkeleton().joint_names;
  return std::all_of(body.begin(), body.end(), [&joint_names](const std::string& name) {
    return std::find(joint_names.begin(), joint_names.end(), name) != joint_names.end();
  });
}

absl::StatusOr<motion::Clip> ToBody(const motion::Clip& person, std::vector<std::string>* placed) {
  motion::Clip body;
  body.joint_names = BodySkeleton().joint_names;
  body.frame_rate_hz = person.frame_rate_hz;
  Joints joints(person);
  if (HasBodyJoints(person.joint_names)) {
    for (int frame = 0; frame < person.frame_count(); ++frame) {
      std::vector<Vec3> pose;
      for (const std::string& name : body.joint_names) {
        pose.push_back(person.at(frame, *joints.First({name.c_str()})));
      }
      body.Append(pose);
    }
    return body;
  }
  const Anatomy anatomy = Find(&joints);
  if (!joints.missing().empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("joints: expected ", absl::StrJoin(joints.missing(), ", "), ", got only ",
                     absl::StrJoin(person.joint_names, ", ")));
  }
  for (int frame = 0; frame < person.frame_count(); ++frame) {
    body.Append(BodyPose(anatomy, person.poses[frame]));
  }
  if (placed != nullptr) {
    *placed = {"spine1", "spine2", "spine3", "left_collar", "right_collar", "head"};
    if (!anatomy.pelvis) placed->insert(placed->begin(), "pelvis");
    if (!anatomy.left.toe) placed->push_back("left_foot");
    if (!anatomy.right.toe) placed->push_back("right_foot");
  }
  return body;
}

}  // namespace duet::formats::research
