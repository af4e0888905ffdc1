#include "model/retargeting/joint_mapping.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/retargeting/joint_names.h"
#include "tests/support/matchers.h"

namespace duet::retargeting {
namespace {

// What one program calls the joints of a person in a T pose. '@' is the side.
struct Convention {
  const char* name;
  const char* left;
  const char* right;
  // Height of the joints of the middle, metres.
  std::map<std::string, float> middle;
  const char *collar, *shoulder, *elbow, *hand, *hip, *knee, *foot, *toe;
  const char* torso;  // expected
};

void PrintTo(const Convention& convention, std::ostream* out) { *out << convention.name; }

struct NamedPose {
  std::vector<std::string> names;
  std::vector<motion::Vec3> positions;
};

NamedPose MakePose(const Convention& c) {
  NamedPose pose;
  const auto add = [&pose](const std::string& name, motion::Vec3 at) {
    if (name.empty()) return;
    pose.names.push_back(name);
    pose.positions.push_back(at);
  };
  for (const auto& [name, height] : c.middle) add(name, {0, height, 0});
  for (const float side : {1.0f, -1.0f}) {
    const auto add_limb = [&](const char* name, float x, float y, float z) {
      add(absl::StrReplaceAll(name, {{"@", side > 0 ? c.left : c.right}}), {x * side, y, z});
    };
    add_limb(c.collar, 0.05f, 1.42f, 0);
    add_limb(c.shoulder, 0.17f, 1.4f, 0);
    add_limb(c.elbow, 0.46f, 1.4f, 0);
    add_limb(c.hand, 0.72f, 1.4f, 0);
    add_limb(c.hip, 0.1f, 0.92f, 0);
    add_limb(c.knee, 0.1f, 0.5f, 0);
    add_limb(c.foot, 0.1f, 0.08f, 0);
    add_limb(c.toe, 0.1f, 0.02f, 0.15f);
  }
  return pose;
}

motion::Poses OneFrame(const NamedPose& pose) {
  return motion::Poses(static_cast<int>(pose.names.size()), pose.positions);
}

// The pose as the rest pose of a rig: the middle as a chain from the lowest joint up, collars on
// the highest joint of the spine, legs on the lowest one.
JointTree MakeTree(const Convention& c) {
  const NamedPose pose = MakePose(c);
  JointTree tree;
  std::vector<motion::Vec3> places;
  const auto add = [&](std::size_t from, int parent) {
    const motion::Vec3 origin = parent < 0 ? motion::Vec3{} : places[static_cast<size_t>(parent)];
    tree.names.push_back(pose.names[from]);
    tree.parents.push_back(parent);
    tree.offsets.push_back(ToDouble(pose.positions[from] - origin));
    places.push_back(pose.positions[from]);
    return static_cast<int>(places.size()) - 1;
  };
  std::vector<std::size_t> middle(c.middle.size());
  std::iota(middle.begin(), middle.end(), 0u);
  std::stable_sort(middle.begin(), middle.end(), [&pose](std::size_t a, std::size_t b) {
    return pose.positions[a].y < pose.positions[b].y;
  });
  int parent = -1, chest = 0;
  for (std::size_t joint : middle) {
    parent = add(joint, parent);
    if (IsSpine(ParseJointName(pose.names[joint]))) chest = parent;
  }
  parent = -1;
  for (std::size_t joint = middle.size(); joint < pose.names.size(); ++joint) {
    const motion::Vec3 at = pose.positions[joint];
    const bool starts = std::abs(at.x) < 0.06f || at.y == 0.92f;
    parent = add(joint, !starts ? parent : at.y < 1 ? 0 : chest);
  }
  return tree;
}

std::vector<motion::Vec3> MapPose(const JointMap& map, const JointTree& tree,
                                  const NamedPose& pose) {
  std::vector<motion::Vec3> places;
  for (const std::string& name : tree.names) {
    const auto at = std::find(pose.names.begin(), pose.names.end(), name) - pose.names.begin();
    places.push_back(pose.positions[static_cast<size_t>(at)]);
  }
  return ApplyJointMap(map, places);
}

const Convention kConventions[] = {
    {"Mixamo",
     "Left",
     "Right",
     {{"mixamorig:Hips", 0.97f},
      {"mixamorig:Spine", 1.07f},
      {"mixamorig:Spine1", 1.18f},
      {"mixamorig:Spine2", 1.3f},
      {"mixamorig:Neck", 1.46f},
      {"mixamorig:Head", 1.55f},
      {"mixamorig:HeadTop_End", 1.74f}},
     "mixamorig:@Shoulder",
     "mixamorig:@Arm",
     "mixamorig:@ForeArm",
     "mixamorig:@Hand",
     "mixamorig:@UpLeg",
     "mixamorig:@Leg",
     "mixamorig:@Foot",
     "mixamorig:@ToeBase",
     "mixamorig:Spine1"},
    {"CMU by cgspeed",
     "Left",
     "Right",
     {{"Hips", 0.97f},
      {"LowerBack", 0.97f},
      {"Spine", 1.14f},
      {"Spine1", 1.28f},
      {"Neck", 1.28f},
      {"Neck1", 1.44f},
      {"Head", 1.53f},
      {"Head.end", 1.53f}},
     "@Shoulder",
     "@Arm",
     "@ForeArm",
     "@Hand",
     "@UpLeg",
     "@Leg",
     "@Foot",
     "@ToeBase",
     "Spine"},
    {"3ds Max Biped",
     "L",
     "R",
     {{"Bip01 Pelvis", 0.97f},
      {"Bip01 Spine", 1.05f},
      {"Bip01 Spine1", 1.17f},
      {"Bip01 Spine2", 1.3f},
      {"Bip01 Neck", 1.45f},
      {"Bip01 Head", 1.53f},
      {"Bip01 Head.end", 1.72f}},
     "Bip01 @ Clavicle",
     "Bip01 @ UpperArm",
     "Bip01 @ Forearm",
     "Bip01 @ Hand",
     "Bip01 @ Thigh",
     "Bip01 @ Calf",
     "Bip01 @ Foot",
     "Bip01 @ Toe0",
     "Bip01 Spine1"},
    {"Perception Neuron",
     "Left",
     "Right",
     {{"Hips", 0.97f},
      {"Spine", 1.07f},
      {"Spine1", 1.17f},
      {"Spine2", 1.27f},
      {"Spine3", 1.37f},
      {"Neck", 1.45f},
      {"Head", 1.54f},
      {"Head.end", 1.72f}},
     "@Shoulder",
     "@Arm",
     "@ForeArm",
     "@Hand",
     "@UpLeg",
     "@Leg",
     "@Foot",
     "",
     "Spine1"},
    {"SMPL",
     "L",
     "R",
     {{"Pelvis", 0.95f},
      {"Spine1", 1.05f},
      {"Spine2", 1.18f},
      {"Spine3", 1.24f},
      {"Neck", 1.45f},
      {"Head", 1.54f}},
     "@_Collar",
     "@_Shoulder",
     "@_Elbow",
     "@_Wrist",
     "@_Hip",
     "@_Knee",
     "@_Ankle",
     "@_Foot",
     "Spine2"},
    {"Poser, DAZ, Second Life",
     "l",
     "r",
     {{"hip", 0.97f},
      {"abdomen", 0.98f},
      {"chest", 1.16f},
      {"neck", 1.42f},
      {"head", 1.52f},
      {"head.end", 1.7f}},
     "@Collar",
     "@Shldr",
     "@ForeArm",
     "@Hand",
     "@Thigh",
     "@Shin",
     "@Foot",
     "",
     "chest"},
    {"Blender Rigify",
     "L",
     "R",
     {{"spine", 0.95f},
      {"spine.001", 1.07f},
      {"spine.002", 1.19f},
      {"spine.003", 1.3f},
      {"neck", 1.45f},
      {"head", 1.54f},
      {"head.end", 1.74f}},
     "shoulder.@",
     "upper_arm.@",
     "forearm.@",
     "hand.@",
     "thigh.@",
     "shin.@",
     "foot.@",
     "toe.@",
     "spine.002"},
    {"Unreal",
     "l",
     "r",
     {{"pelvis", 0.95f},
      {"spine_01", 1.06f},
      {"spine_02", 1.19f},
      {"spine_03", 1.28f},
      {"neck_01", 1.45f},
      {"head", 1.54f}},
     "clavicle_@",
     "upperarm_@",
     "lowerarm_@",
     "hand_@",
     "thigh_@",
     "calf_@",
     "foot_@",
     "ball_@",
     "spine_02"},
    {"VRM",
     "L",
     "R",
     {{"J_Bip_C_Hips", 0.97f},
      {"J_Bip_C_Spine", 1.03f},
      {"J_Bip_C_Chest", 1.15f},
      {"J_Bip_C_UpperChest", 1.27f},
      {"J_Bip_C_Neck", 1.43f},
      {"J_Bip_C_Head", 1.51f}},
     "J_Bip_@_Shoulder",
     "J_Bip_@_UpperArm",
     "J_Bip_@_LowerArm",
     "J_Bip_@_Hand",
     "J_Bip_@_UpperLeg",
     "J_Bip_@_LowerLeg",
     "J_Bip_@_Foot",
     "J_Bip_@_ToeBase",
     "J_Bip_C_Chest"},
    {"Biovision",
     "Left",
     "Right",
     {{"Hips", 0.97f}, {"Chest", 1.12f}, {"Neck", 1.42f}, {"Head", 1.5f}, {"Head.end", 1.72f}},
     "@Collar",
     "@Shoulder",
     "@Elbow",
     "@Wrist",
     "@Hip",
     "@Knee",
     "@Ankle",
     "@Toe",
     "Chest"},
    {"Acclaim",
     "l",
     "r",
     {{"root", 0.95f},
      {"lowerback", 1.02f},
      {"upperback", 1.14f},
      {"thorax", 1.26f},
      {"lowerneck", 1.4f},
      {"upperneck", 1.48f},
      {"head", 1.55f},
      {"head.end", 1.72f}},
     "@clavicle",
     "@humerus",
     "@radius",
     "@wrist",
     "@femur",
     "@tibia",
     "@foot",
     "@toes",
     "upperback"},
    {"MakeHuman",
     "L",
     "R",
     {{"root", 0.95f},
      {"spine05", 0.98f},
      {"spine04", 1.07f},
      {"spine03", 1.17f},
      {"spine02", 1.27f},
      {"spine01", 1.35f},
      {"neck01", 1.43f},
      {"neck02", 1.47f},
      {"neck03", 1.51f},
      {"head", 1.55f}},
     "clavicle.@",
     "upperarm01.@",
     "lowerarm01.@",
     "wrist.@",
     "upperleg01.@",
     "lowerleg01.@",
     "foot.@",
     "toe1-1.@",
     "spine03"},
    {"MakeHuman, early",
     "L",
     "R",
     {{"Root", 0.95f},
      {"Spine1", 1.03f},
      {"Spine2", 1.16f},
      {"Spine3", 1.28f},
      {"Neck", 1.43f},
      {"Head", 1.54f}},
     "Clavicle_@",
     "UpArm_@",
     "LoArm_@",
     "Hand_@",
     "UpLeg_@",
     "LoLeg_@",
     "Foot_@",
     "Toe_@",
     "Spine2"},
    {"Unity, VRChat",
     "Left",
     "Right",
     {{"Hips", 0.97f}, {"Spine", 1.07f}, {"Chest", 1.2f}, {"Neck", 1.43f}, {"Head", 1.54f}},
     "@ shoulder",
     "@ arm",
     "@ elbow",
     "@ wrist",
     "@ leg",
     "@ knee",
     "@ ankle",
     "@ toe",
     "Chest"}};

class Conventions : public ::testing::TestWithParam<Convention> {};

void ExpectEveryJoint(const std::vector<motion::Vec3>& mapped) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  ASSERT_EQ(mapped.size(), 15u);
  const motion::Vec3 limbs[] = {{0.17f, 1.4f, 0}, {0.46f, 1.4f, 0}, {0.72f, 1.4f, 0},
                                {0.1f, 0.92f, 0}, {0.1f, 0.5f, 0},  {0.1f, 0.08f, 0}};
  for (int i = 0; i < 6; ++i) {
    const size_t left = i < 3 ? 3u + i : 6u + i, right = left + 3;
    const motion::Vec3 mirrored = {-limbs[i].x, limbs[i].y, limbs[i].z};
    EXPECT_LT(Distance(mapped[left], limbs[i]), 1e-5f) << skeleton.joint_names[left];
    EXPECT_LT(Distance(mapped[right], mirrored), 1e-5f) << skeleton.joint_names[right];
  }
  EXPECT_NEAR(mapped[0].y, 1.63, 0.04) << "head";
  EXPECT_NEAR(mapped[1].y, 1.42, 0.05) << "neck";
}

TEST_P(Conventions, FindEveryJointInAHierarchy) {
  const JointTree tree = MakeTree(GetParam());
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", tree, motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  ExpectEveryJoint(MapPose(*map, tree, MakePose(GetParam())));
  EXPECT_THAT(map->notes, Contains(HasSubstr(std::string("torso: ") + GetParam().torso + " (")));
}

// Some rigs turn every joint's axes along its bone: at rest all bones lie on a line.
TEST_P(Conventions, FindEveryJointInAnyRestPose) {
  JointTree tree = MakeTree(GetParam());
  for (std::size_t j = 0; j < tree.names.size(); ++j) {
    if (ParseJointName(tree.names[j]).side != BodySide::kMiddle) continue;
    tree.offsets[j] = {Norm(tree.offsets[j]), 0, 0};
  }
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", tree, motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  ExpectEveryJoint(MapPose(*map, tree, MakePose(GetParam())));
  EXPECT_THAT(map->notes, Contains(HasSubstr(std::string("torso: ") + GetParam().torso + " (")));
}

TEST_P(Conventions, FindEveryJointWithoutAHierarchy) {
  const NamedPose pose = MakePose(GetParam());
  const absl::StatusOr<JointMap> map =
      MapJoints("a.csv", pose.names, OneFrame(pose), motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  ExpectEveryJoint(ApplyJointMap(*map, pose.positions));
  EXPECT_THAT(map->notes, Contains(HasSubstr(std::string("torso: ") + GetParam().torso + " (")));
}

// The joints of a professional capture: wrists and hands, toes, three joints between hips and neck.
motion::Skeleton CapturedSkeleton() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {
      "hips",          "spine",      "chest",       "neck",      "head",           "head_top",
      "left_shoulder", "left_elbow", "left_wrist",  "left_hand", "right_shoulder", "right_elbow",
      "right_wrist",   "right_hand", "left_hip",    "left_knee", "left_ankle",     "left_toe",
      "right_hip",     "right_knee", "right_ankle", "right_toe"};
  skeleton.hips = motion::JointPair{14, 18};
  return skeleton;
}

TEST_P(Conventions, LeadASkeletonWithWristsAndToes) {
  const std::string toe = GetParam().toe;
  if (toe.empty()) return;
  const motion::Skeleton skeleton = CapturedSkeleton();
  const JointTree tree = MakeTree(GetParam());
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", tree, skeleton);
  ASSERT_TRUE(map.ok()) << map.status();
  const std::vector<motion::Vec3> mapped = MapPose(*map, tree, MakePose(GetParam()));
  const auto at = [&](const char* name) {
    return mapped[static_cast<std::size_t>(skeleton.Find(name))];
  };
  for (const auto& [name, wanted] :
       std::map<const char*, motion::Vec3>{{"left_wrist", {0.72f, 1.4f, 0}},
                                           {"right_wrist", {-0.72f, 1.4f, 0}},
                                           {"left_ankle", {0.1f, 0.08f, 0}},
                                           {"left_toe", {0.1f, 0.02f, 0.15f}},
                                           {"right_toe", {-0.1f, 0.02f, 0.15f}}}) {
    EXPECT_LT(Distance(at(name), wanted), 1e-5f) << name;
  }
  EXPECT_GT(at("left_hand").x, 0.75f);  // beyond the wrist
  EXPECT_NEAR(at("hips").y, 0.99, 0.1);
  EXPECT_LT(at("hips").y, at("chest").y);
  EXPECT_LE(at("spine").y, at("chest").y);
  EXPECT_LT(at("chest").y, at("neck").y);
  EXPECT_GT(at("head_top").y, at("head").y + 0.05f);
}

INSTANTIATE_TEST_SUITE_P(All, Conventions, ::testing::ValuesIn(kConventions));

TEST(JointMapping, UsesTheSkeletonsOwnNames) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  std::vector<std::string> names = {"head.end"};
  names.insert(names.end(), skeleton.joint_names.rbegin(), skeleton.joint_names.rend());
  std::vector<motion::Vec3> pose;
  for (std::size_t i = 0; i < names.size(); ++i) pose.push_back({static_cast<float>(i), 0, 0});
  const absl::StatusOr<JointMap> map = MapJoints("a.csv", names, OneFrame({names, pose}), skeleton);
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_TRUE(map->notes.empty());
  const std::vector<motion::Vec3> mapped = ApplyJointMap(*map, pose);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(mapped[i].x, 15.0f - static_cast<float>(i));
}

TEST(JointMapping, ReportsMissingJointsAndTheFilesNames) {
  NamedPose pose = MakePose(kConventions[0]);
  for (std::string& name : pose.names) {
    if (name == "mixamorig:LeftHand") name = "paw";
  }
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", pose.names, OneFrame(pose), motion::SbuSkeleton());
  EXPECT_EQ(map.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(map.status().message()),
              AllOf(HasSubstr("a.bvh: joints: expected joints for left_hand, got none;"),
                    HasSubstr("paw"), HasSubstr("left_hand=NAME")));
}

TEST(JointMapping, FindsATorsoByNameWithoutHips) {
  NamedPose pose;
  pose.names = {"Torso", "Head", "LeftHand", "RightHand"};
  pose.positions = {{0, 1, 0}, {0, 1.5f, 0}, {0.6f, 1, 0}, {-0.6f, 1, 0}};
  motion::Skeleton skeleton;
  skeleton.joint_names = {"torso", "head", "left_hand", "right_hand"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}};
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", pose.names, OneFrame(pose), skeleton);
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(ApplyJointMap(*map, pose.positions), pose.positions);
}

TEST(JointMapping, LetsTheUserNameJoints) {
  NamedPose pose = MakePose(kConventions[0]);
  for (std::string& name : pose.names) {
    if (name == "mixamorig:LeftHand") name = "paw";
  }
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", pose.names, OneFrame(pose), motion::SbuSkeleton(),
                {{"left_hand", "paw"}, {"head", "mixamorig:Head"}});
  ASSERT_TRUE(map.ok()) << map.status();
  const std::vector<motion::Vec3> mapped = ApplyJointMap(*map, pose.positions);
  EXPECT_NEAR(mapped[5].x, 0.72, 1e-5);
  EXPECT_NEAR(mapped[0].y, 1.55, 1e-5) << "a joint that the user names is taken as it is";
}

TEST(JointMapping, LetsTheUserNameJointsOfAFileWithTheSkeletonsOwnNames) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  std::vector<std::string> names = skeleton.joint_names;
  names.push_back("marker");
  std::vector<motion::Vec3> pose;
  for (std::size_t i = 0; i < names.size(); ++i) pose.push_back({static_cast<float>(i), 0, 0});
  const absl::StatusOr<JointMap> map =
      MapJoints("a.csv", names, OneFrame({names, pose}), skeleton, {{"left_hand", "marker"}});
  ASSERT_TRUE(map.ok()) << map.status();
  const std::vector<motion::Vec3> mapped = ApplyJointMap(*map, pose);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(mapped[i].x, i == 5 ? 15.0f : static_cast<float>(i)) << skeleton.joint_names[i];
  }
}

TEST(JointMapping, RejectsOverridesOfUnknownJoints) {
  const NamedPose pose = MakePose(kConventions[0]);
  const absl::StatusOr<JointMap> tail = MapJoints(
      "a.bvh", pose.names, OneFrame(pose), motion::SbuSkeleton(), {{"tail", "mixamorig:Hips"}});
  EXPECT_THAT(std::string(tail.status().message()),
              HasSubstr("joint map: target: expected one of"));
  const absl::StatusOr<JointMap> nothing =
      MapJoints("a.bvh", pose.names, OneFrame(pose), motion::SbuSkeleton(), {{"torso", "Nothing"}});
  EXPECT_THAT(std::string(nothing.status().message()),
              HasSubstr("torso=Nothing: a.bvh has no such joint"));
}

TEST(JointMapping, InterpolatesTheTorsoIfNoSpineJointIsNear) {
  NamedPose pose = MakePose(kConventions[0]);
  for (std::string& name : pose.names) {
    if (name.find("Spine") != std::string::npos) name = "part of " + name;
  }
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", pose.names, OneFrame(pose), motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_THAT(map->notes, Contains(HasSubstr("torso:")));
}

TEST(JointMapping, MeasuresTheTrunkOverTheWholeMotion) {
  NamedPose pose = MakePose(kConventions[0]);
  const auto spine1 = std::find(pose.names.begin(), pose.names.end(), "mixamorig:Spine1");
  const auto at = static_cast<size_t>(spine1 - pose.names.begin());
  motion::Poses poses = OneFrame(pose);
  std::swap(poses.at(0, static_cast<int>(at)), poses.at(0, static_cast<int>(at) + 1));
  for (int frame = 1; frame < 4; ++frame) poses.Append(pose.positions);
  const absl::StatusOr<JointMap> map = MapJoints("a.csv", pose.names, poses, motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_THAT(map->notes, Contains(HasSubstr("torso: mixamorig:Spine1 (")));
}

TEST(JointMapping, UsesTheEndOfTheNeckAsAMissingHead) {
  Convention c = kConventions[0];
  c.middle = {{"Hips", 0.97f}, {"Spine", 1.18f}, {"Neck", 1.43f}, {"Neck.end", 1.63f}};
  const JointTree tree = MakeTree(c);
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", tree, motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  ExpectEveryJoint(MapPose(*map, tree, MakePose(c)));
  EXPECT_THAT(map->notes, Contains(HasSubstr("head: Neck.end (the end of the neck")));
}

TEST(JointMapping, UsesNoOtherEndAsAHead) {
  Convention c = kConventions[0];
  c.middle = {{"Hips", 0.97f}, {"Spine", 1.18f}, {"Neck", 1.43f}, {"left ear end", 1.63f}};
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", MakeTree(c), motion::SbuSkeleton());
  EXPECT_THAT(std::string(map.status().message()),
              HasSubstr("expected joints for head, got none;"));
}

TEST(JointMapping, StraightensTheCharacterFromTheHierarchyOnly) {
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", MakeTree(kConventions[0]), motion::SbuSkeleton());
  ASSERT_TRUE(map.ok()) << map.status();
  ASSERT_EQ(map->straight.size(), 15u);
  EXPECT_NEAR(Distance(map->straight[9], map->straight[10]), 0.42, 1e-5) << "thigh";
  EXPECT_NEAR(Distance(map->straight[3], map->straight[4]), 0.29, 1e-5) << "upper arm";
  EXPECT_NEAR(map->straight[2].y - map->straight[9].y, 0.26, 1e-5) << "torso above the hips";
}

TEST(JointMapping, TheFilesHandIsTheWristIfTheUserNamesTheHand) {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"left_elbow", "left_wrist", "left_hand"};
  const std::vector<std::string> names = {"LeftForeArm", "LeftHand", "Knuckles"};
  const std::vector<motion::Vec3> pose = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", names, OneFrame({names, pose}), skeleton, {{"left_hand", "Knuckles"}});
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(ApplyJointMap(*map, pose)[1].x, 2);
  EXPECT_EQ(ApplyJointMap(*map, pose)[2].x, 3);
}

TEST(JointMapping, KeepsWristAndHandApartForASkeletonWithBoth) {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"left_hand", "left_wrist"};
  const std::vector<std::string> names = {"LeftWrist", "LeftHand"};
  const std::vector<motion::Vec3> pose = {{1, 0, 0}, {2, 0, 0}};
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", names, OneFrame({names, pose}), skeleton);
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(ApplyJointMap(*map, pose)[0].x, 2);
}

// A person in the names of one program, with helpers and copies.
class NamesakeTest : public ::testing::Test {
 protected:
  int Add(const std::string& name, int parent, Vec3d offset) {
    tree_.names.push_back(name);
    tree_.parents.push_back(parent);
    tree_.offsets.push_back(offset);
    return static_cast<int>(tree_.names.size()) - 1;
  }

  // Adds head and neck, and on each side an arm and a leg that `add_limbs` adds.
  template <typename AddLimbs>
  void AddPerson(AddLimbs add_limbs) {
    hips_ = Add("Hips", -1, {});
    chest_ = Add("Spine", hips_, {0, 0.4, 0});
    Add("Head", Add("Neck", chest_, {0, 0.1, 0}), {0, 0.15, 0});
    for (const char side : {'L', 'R'}) add_limbs(std::string(1, side), side == 'L' ? 1.0 : -1.0);
  }

  // The number in the file of the joint that was found for `target`.
  int Find(const std::string& target) {
    const motion::Skeleton skeleton = motion::SbuSkeleton();
    const absl::StatusOr<JointMap> map = MapJoints("a.bvh", tree_, skeleton);
    EXPECT_THAT(map, IsOk());
    if (!map.ok()) return -1;
    notes_ = map->notes;
    return map->sources[static_cast<std::size_t>(skeleton.Find(target))].terms[0].joint;
  }

  JointTree tree_;
  int hips_ = 0, chest_ = 0;
  std::vector<std::string> notes_;
};

// MakeHuman's rigs have `__UpLeg_L` in the pelvis above `UpLeg_L`, with nothing else in its name.
TEST_F(NamesakeTest, AHelperAtThePelvisIsNoHip) {
  std::map<std::string, int> joints;
  AddPerson([&](const std::string& side, double sign) {
    const int helper = Add("__UpLeg_" + side, hips_, {});
    joints["hip" + side] = Add("UpLeg_" + side, helper, {0.1 * sign, -0.05, 0});
    Add("Foot_" + side, Add("LoLeg_" + side, joints["hip" + side], {0, -0.45, 0}), {0, -0.42, 0});
    const int shoulder = Add("__UpArm_" + side, chest_, {});
    joints["shoulder" + side] = Add("UpArm_" + side, shoulder, {0.18 * sign, 0, 0});
    Add("Hand_" + side, Add("LoArm_" + side, joints["shoulder" + side], {0.28 * sign, 0, 0}),
        {0.25 * sign, 0, 0});
  });
  EXPECT_EQ(Find("left_hip"), joints["hipL"]);
  EXPECT_EQ(Find("right_hip"), joints["hipR"]);
  EXPECT_EQ(Find("left_shoulder"), joints["shoulderL"]);
  EXPECT_EQ(Find("right_shoulder"), joints["shoulderR"]);
  EXPECT_THAT(notes_, Contains("left_hip: UpLeg_L (of 2 joints of that name, the one that makes a "
                               "limb)"));
}

// Half way down the thigh, and in the shin: twist joints that have lost their own words.
TEST_F(NamesakeTest, AJointWithinABoneIsNoEndOfIt) {
  std::map<std::string, int> joints;
  AddPerson([&](const std::string& side, double sign) {
    joints["hip" + side] = Add("UpLeg_" + side, hips_, {0.1 * sign, -0.05, 0});
    const int within = Add("_UpLeg_" + side, joints["hip" + side], {0, -0.2, 0});
    const int knee = Add("LoLeg_" + side, within, {0, -0.25, 0});
    const int shin = Add("_LoLeg_" + side, knee, {0, -0.2, 0});
    joints["knee" + side] = knee;
    Add("Foot_" + side, shin, {0, -0.22, 0});
    const int shoulder = Add("UpArm_" + side, chest_, {0.18 * sign, 0, 0});
    Add("Hand_" + side, Add("LoArm_" + side, shoulder, {0.28 * sign, 0, 0}), {0.25 * sign, 0, 0});
  });
  for (const char* side : {"left_", "right_"}) {
    const std::string letter = side[0] == 'l' ? "L" : "R";
    EXPECT_EQ(Find(std::string(side) + "hip"), joints["hip" + letter]);
    EXPECT_EQ(Find(std::string(side) + "knee"), joints["knee" + letter]);
  }
}

TEST_F(NamesakeTest, TheHandIsTheOneOfTheArm) {
  std::map<std::string, int> hands;
  AddPerson([&](const std::string& side, double sign) {
    Add("Hand_" + side, hips_, {0.6 * sign, 0.3, 0});  // a target of inverse kinematics
    const int shoulder = Add("UpArm_" + side, chest_, {0.18 * sign, 0, 0});
    const int elbow = Add("LoArm_" + side, shoulder, {0.28 * sign, 0, 0});
    hands[side] = Add("Hand_" + side, elbow, {0.25 * sign, 0, 0});
    Add("Hand_" + side, hands[side], {0.4 * sign, 0, 0});  // what it holds
    const int hip = Add("UpLeg_" + side, hips_, {0.1 * sign, -0.05, 0});
    Add("Foot_" + side, Add("LoLeg_" + side, hip, {0, -0.45, 0}), {0, -0.42, 0});
  });
  EXPECT_EQ(Find("left_hand"), hands["L"]);
  EXPECT_EQ(Find("right_hand"), hands["R"]);
  EXPECT_THAT(notes_, Contains(HasSubstr("left_hand: Hand_L (of 3 joints of that name")));
}

TEST_F(NamesakeTest, AnotherJointIsTheFirstOfItsNameWithANote) {
  AddPerson([&](const std::string& side, double sign) {
    const int shoulder = Add("UpArm_" + side, chest_, {0.18 * sign, 0, 0});
    Add("Hand_" + side, Add("LoArm_" + side, shoulder, {0.28 * sign, 0, 0}), {0.25 * sign, 0, 0});
    const int hip = Add("UpLeg_" + side, hips_, {0.1 * sign, -0.05, 0});
    Add("Foot_" + side, Add("LoLeg_" + side, hip, {0, -0.45, 0}), {0, -0.42, 0});
  });
  Add("Head", hips_, {0, 1, 0});
  EXPECT_EQ(tree_.names[static_cast<std::size_t>(Find("head"))], "Head");
  EXPECT_THAT(notes_, Contains("head: Head (the first of 2 joints of that name)"));
}

TEST(JointMapping, SurvivesNamesOfEveryKind) {
  const std::vector<std::string> names = {"",     ":",        "_",    "l",
                                          "Left", "\xff\xfe", "head", "head.end"};
  const std::vector<motion::Vec3> pose(names.size());
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", names, OneFrame({names, pose}), motion::SbuSkeleton());
  EXPECT_THAT(std::string(map.status().message()), Not(HasSubstr("for head")));
}

}  // namespace
}  // namespace duet::retargeting
