// Followers with toes, wrists and hands on the rigs of other programs.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/formats/bvh/bvh_motion.h"
#include "tests/formats/bvh/rig_families.h"
#include "tests/support/status_matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::bvh {
namespace {

using motion::Vec3;
using test::IsOk;
using test::RigFamily;

constexpr float kStandingSlope = 0.35f;  // of the follower's feet, radians
constexpr float kFootLength = 0.15f;     // metres

// The joints of the embedded model salsa.
motion::Skeleton DancersSkeleton() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"hips", "spine", "chest", "neck", "head", "head_top"};
  skeleton.bones = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}};
  for (const std::string side : {"left_", "right_"}) {
    for (const auto& [top, names] :
         {std::pair(2, std::vector<std::string>{"shoulder", "elbow", "wrist", "hand"}),
          std::pair(0, std::vector<std::string>{"hip", "knee", "ankle", "toe"})}) {
      int parent = top;
      for (const std::string& name : names) {
        skeleton.joint_names.push_back(side + name);
        skeleton.bones.push_back({parent, skeleton.joint_count() - 1});
        parent = skeleton.joint_count() - 1;
      }
    }
  }
  skeleton.hips = {skeleton.Find("left_hip"), skeleton.Find("right_hip")};
  skeleton.feet = {skeleton.Find("left_ankle"), skeleton.Find("right_ankle")};
  return skeleton;
}

Vec3 Direction(Vec3 from, Vec3 to) { return (to - from) / Distance(from, to); }

// Slope of a foot whose heel rises while its toe stays on the floor, as far as it reaches.
float SlopeAt(float rise) {
  return std::asin(std::min(std::sin(kStandingSlope) + rise / kFootLength, 0.93f));
}

// Adds wrists and hands, ankles and toes to one side of a frame. `ahead` is level.
void AddSide(const std::string& side, int frame, Vec3 ahead, float floor, const motion::Clip& body,
             const motion::Skeleton& skeleton, std::vector<Vec3>* pose) {
  const motion::Skeleton sbu = motion::SbuSkeleton();
  const auto from = [&](const std::string& name) { return body.at(frame, sbu.Find(side + name)); };
  const auto set = [&](const std::string& name, Vec3 at) {
    (*pose)[static_cast<std::size_t>(skeleton.Find(side + name))] = at;
  };
  for (const char* name : {"shoulder", "elbow", "hip", "knee"}) set(name, from(name));
  const Vec3 wrist = from("hand"), forearm = Direction(from("elbow"), wrist);
  const float bend = 0.6f * std::sin(0.2f * static_cast<float>(frame));
  const Vec3 swung = forearm + ahead * bend;
  set("wrist", wrist);
  set("hand", wrist + swung * (0.09f / Norm(swung)));
  const Vec3 ankle = from("foot");
  const float slope = SlopeAt(ankle.y - floor);
  set("ankle", ankle);
  set("toe", ankle + (ahead * std::cos(slope) + Vec3{0, -std::sin(slope), 0}) * kFootLength);
}

// Walks on the spot in a turn; heels rise with the feet, hands bend at the wrists.
motion::Clip Dancer(const motion::Skeleton& skeleton) {
  test::PersonOptions options;
  options.frames = 120;
  options.yaw = 2;
  options.turn = 5;
  options.at = {0.4f, 1.13f, -0.8f};
  const motion::Clip body = test::MakePerson(options);
  const motion::Skeleton sbu = motion::SbuSkeleton();
  motion::Clip clip;
  clip.joint_names = skeleton.joint_names;
  clip.frame_rate_hz = body.frame_rate_hz;
  float floor = 1;
  for (int frame = 0; frame < body.frame_count(); ++frame) {
    floor = std::min({floor, body.at(frame, sbu.feet->left).y, body.at(frame, sbu.feet->right).y});
  }
  for (int frame = 0; frame < body.frame_count(); ++frame) {
    const auto at = [&](const char* name) { return body.at(frame, sbu.Find(name)); };
    const Vec3 left = at("left_hip"), right = at("right_hip"), hips = (left + right) / 2;
    std::vector<Vec3> pose(skeleton.joint_names.size());
    pose[0] = motion::Lerp(hips, at("neck"), 0.15f);
    pose[1] = at("torso");
    pose[2] = motion::Lerp(at("torso"), at("neck"), 0.6f);
    pose[3] = at("neck");
    pose[4] = motion::Lerp(at("neck"), at("head"), 0.5f);
    pose[5] = motion::Lerp(at("neck"), at("head"), 1.8f);
    const Vec3 across = right - left;
    const Vec3 ahead = Vec3{across.z, 0, -across.x} / std::hypot(across.x, across.z);
    AddSide("left_", frame, ahead, floor, body, skeleton, &pose);
    AddSide("right_", frame, ahead, floor, body, skeleton, &pose);
    clip.Append(pose);
  }
  return clip;
}

BvhImportOptions OptionsFor(const motion::Skeleton& skeleton) {
  BvhImportOptions options;
  options.skeleton = skeleton;
  options.missing_toes = retargeting::MissingToes::kAtTheFeet;
  return options;
}

class BvhRigEnds : public ::testing::TestWithParam<RigFamily> {
 protected:
  BvhRigEnds() : skeleton_(DancersSkeleton()), dancer_(Dancer(skeleton_)) {
    const absl::StatusOr<BvhDocument> written =
        OntoBvhRig(dancer_, GetParam().document, "rig.bvh", OptionsFor(skeleton_));
    EXPECT_THAT(written.status(), IsOk());
    if (!written.ok()) return;
    written_ = *written;
    const absl::StatusOr<motion::Clip> read = FromBvh(written_, "written", OptionsFor(skeleton_));
    EXPECT_THAT(read.status(), IsOk());
    on_rig_ = read.value_or(motion::Clip());
  }

  static bool HasJoint(const std::string& part) {
    const auto& joints = GetParam().document.joints;
    return std::any_of(joints.begin(), joints.end(), [&part](const BvhJoint& joint) {
      return joint.name.find(part) != std::string::npos;
    });
  }
  int Find(const std::string& name) const { return skeleton_.Find(name); }
  // The height of the lowest toe.
  float Floor() const {
    float floor = 1;
    for (int frame = 0; frame < dancer_.frame_count(); ++frame) {
      floor = std::min(floor, dancer_.at(frame, Find("left_toe")).y);
    }
    return floor;
  }

  const motion::Skeleton skeleton_;
  const motion::Clip dancer_;
  BvhDocument written_;
  motion::Clip on_rig_;  // the same joints, read back
};

// Both slope from the standing foot: the rig's foot has another height than the follower's.
TEST_P(BvhRigEnds, FeetPointAtTheFollowersToes) {
  const absl::StatusOr<motion::Clip> rest =
      FromBvh(GetParam().document, "rig", OptionsFor(skeleton_));
  ASSERT_THAT(rest.status(), IsOk());
  const motion::Clip& at_rest = *rest;
  for (int frame = 0; frame < dancer_.frame_count(); ++frame) {
    for (const std::string side : {"left_", "right_"}) {
      const auto foot = [&](const motion::Clip& clip, int at) {
        return Direction(clip.at(at, Find(side + "ankle")), clip.at(at, Find(side + "toe")));
      };
      const Vec3 wanted = foot(dancer_, frame), got = foot(on_rig_, frame);
      const double heading =
          std::atan2(static_cast<double>(got.x), static_cast<double>(got.z)) -
          std::atan2(static_cast<double>(wanted.x), static_cast<double>(wanted.z));
      EXPECT_NEAR(std::remainder(heading, 2 * base::kPi), 0, 0.07) << side << frame;
      const float raised = std::asin(-got.y) - std::asin(-foot(at_rest, 0).y);
      EXPECT_NEAR(raised, std::asin(-wanted.y) - kStandingSlope, 0.05f) << side << frame;
    }
  }
}

// The end of the toe is level with the toe's joint at rest.
TEST_P(BvhRigEnds, ToesStayLevelWhileTheHeelIsUp) {
  if (!HasJoint("oe") && !HasJoint("ball_l")) return;  // it calls them feet
  int raised = 0;
  for (std::size_t end = 0; end < written_.joints.size(); ++end) {
    const std::size_t toe = static_cast<std::size_t>(std::max(written_.joints[end].parent, 0));
    const std::string& name = written_.joints[toe].name;
    const bool is_toe = name.find("oe") != std::string::npos || name.find("ball") == 0;
    if (!written_.joints[end].end_site || !is_toe) continue;
    const bool left = name.find("eft") != std::string::npos ||
                      name.find('L') != std::string::npos || name.find("_l") != std::string::npos;
    const int ankle = Find(left ? "left_ankle" : "right_ankle");
    for (int frame = 0; frame < dancer_.frame_count(); ++frame) {
      const float toe_y = dancer_.at(frame, ankle + 1).y;
      const float heel =
          dancer_.at(frame, ankle).y - toe_y - kFootLength * std::sin(kStandingSlope);
      if (heel < 0.03f || toe_y > Floor() + 0.01f) continue;
      ++raised;
      const std::vector<retargeting::Vec3d> at = PoseAt(written_, frame).positions;
      const retargeting::Vec3d offset = written_.joints[end].offset;
      const retargeting::Vec3d direction = at[end] - at[toe];
      const bool z_up = std::abs(offset.y) > std::abs(offset.z);
      const double up = (z_up ? direction.z : direction.y) / Norm(direction);
      EXPECT_NEAR(up, 0, 0.05) << name << frame;
    }
  }
  EXPECT_GT(raised, 5);
}

TEST_P(BvhRigEnds, HandsPointAsTheFollowers) {
  if (!HasJoint("iddle1") && !HasJoint("middle_01")) return;  // no joint that Duet knows
  for (int frame = 0; frame < dancer_.frame_count(); ++frame) {
    for (const std::string side : {"left_", "right_"}) {
      const auto hand = [&](const motion::Clip& clip) {
        return Direction(clip.at(frame, Find(side + "wrist")), clip.at(frame, Find(side + "hand")));
      };
      EXPECT_GT(Dot(hand(on_rig_), hand(dancer_)), 0.9999f) << side << frame;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, BvhRigEnds, ::testing::ValuesIn(test::RigFamilies()),
                         [](const ::testing::TestParamInfo<RigFamily>& family) {
                           std::string name = family.param.name;
                           name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                           return name;
                         });

// A motion on a rig, as a reader of the written file has it.
absl::StatusOr<motion::Clip> OnRigAndBack(const motion::Clip& clip, const BvhDocument& rig,
                                          const motion::Skeleton& skeleton) {
  const absl::StatusOr<BvhDocument> written =
      OntoBvhRig(clip, rig, "rig.bvh", OptionsFor(skeleton));
  if (!written.ok()) return written.status();
  return FromBvh(*written, "written", OptionsFor(skeleton));
}

// A leader's file must have the joints that a model reads; only a rig may lack toes.
TEST(BvhRigWithoutToes, IsFollowedByAnklesAndRejectedAsAMotion) {
  BvhDocument rig = test::RigFamilies()[1].document;
  for (BvhJoint& joint : rig.joints) {
    if (joint.name.find("Toe") != std::string::npos) joint.name = "mixamorig:LeftCharm";
  }
  const motion::Skeleton skeleton = DancersSkeleton();
  BvhImportOptions options;
  options.skeleton = skeleton;
  EXPECT_THAT(FromBvh(rig, "rig.bvh", options).status(),
              test::StatusIs(absl::StatusCode::kInvalidArgument, ::testing::HasSubstr("left_toe")));
  const motion::Clip dancer = Dancer(skeleton);
  const absl::StatusOr<motion::Clip> read = OnRigAndBack(dancer, rig, skeleton);
  ASSERT_THAT(read.status(), IsOk());
  const int ankle = skeleton.Find("right_ankle");
  for (int frame = 0; frame < dancer.frame_count(); ++frame) {
    EXPECT_LT(Distance(read->at(frame, ankle), dancer.at(frame, ankle)), 0.002) << frame;
  }
}

}  // namespace
}  // namespace duet::formats::bvh
