#include "model/retargeting/joint_mapping.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "gmock/gmock.h"
#include "model/retargeting/joint_names.h"
#include "tests/support/matchers.h"

namespace duet::retargeting {
namespace {

// What one program calls the joints of a person in a T pose. '@' is the side.
struct Convention {
  std::string name, left, right;
  std::string torso;                    // expected
  std::map<std::string, float> middle;  // joints and their heights, metres
  // Collar, shoulder, elbow, hand, hip, knee, foot and toe; empty if there is none.
  std::vector<std::string> limbs;
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
    const motion::Vec3 places[] = {{0.05f, 1.42f, 0}, {0.17f, 1.4f, 0},    {0.46f, 1.4f, 0},
                                   {0.72f, 1.4f, 0},  {0.1f, 0.92f, 0},    {0.1f, 0.5f, 0},
                                   {0.1f, 0.08f, 0},  {0.1f, 0.02f, 0.15f}};
    for (std::size_t i = 0; i < c.limbs.size(); ++i) {
      add(absl::StrReplaceAll(c.limbs[i], {{"@", side > 0 ? c.left : c.right}}),
          {places[i].x * side, places[i].y, places[i].z});
    }
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

// Each row: name | left | right | expected torso | joints of the middle with their heights in
// metres | collar, shoulder, elbow, hand, hip, knee, foot and toe, with '@' for the side.
constexpr char kConventions[] = R"(
Mixamo | Left | Right | mixamorig:Spine1 |
    mixamorig:Hips 0.97, mixamorig:Spine 1.07, mixamorig:Spine1 1.18, mixamorig:Spine2 1.3,
    mixamorig:Neck 1.46, mixamorig:Head 1.55, mixamorig:HeadTop_End 1.74 |
    mixamorig:@Shoulder, mixamorig:@Arm, mixamorig:@ForeArm, mixamorig:@Hand, mixamorig:@UpLeg,
    mixamorig:@Leg, mixamorig:@Foot, mixamorig:@ToeBase;
CMU by cgspeed | Left | Right | Spine |
    Hips 0.97, LowerBack 0.97, Spine 1.14, Spine1 1.28, Neck 1.28, Neck1 1.44, Head 1.53,
    Head.end 1.53 |
    @Shoulder, @Arm, @ForeArm, @Hand, @UpLeg, @Leg, @Foot, @ToeBase;
3ds Max Biped | L | R | Bip01 Spine1 |
    Bip01 Pelvis 0.97, Bip01 Spine 1.05, Bip01 Spine1 1.17, Bip01 Spine2 1.3, Bip01 Neck 1.45,
    Bip01 Head 1.53, Bip01 Head.end 1.72 |
    Bip01 @ Clavicle, Bip01 @ UpperArm, Bip01 @ Forearm, Bip01 @ Hand, Bip01 @ Thigh,
    Bip01 @ Calf, Bip01 @ Foot, Bip01 @ Toe0;
Perception Neuron | Left | Right | Spine1 |
    Hips 0.97, Spine 1.07, Spine1 1.17, Spine2 1.27, Spine3 1.37, Neck 1.45, Head 1.54,
    Head.end 1.72 |
    @Shoulder, @Arm, @ForeArm, @Hand, @UpLeg, @Leg, @Foot, ;
SMPL | L | R | Spine2 |
    Pelvis 0.95, Spine1 1.05, Spine2 1.18, Spine3 1.24, Neck 1.45, Head 1.54 |
    @_Collar, @_Shoulder, @_Elbow, @_Wrist, @_Hip, @_Knee, @_Ankle, @_Foot;
Poser, DAZ, Second Life | l | r | chest |
    hip 0.97, abdomen 0.98, chest 1.16, neck 1.42, head 1.52, head.end 1.7 |
    @Collar, @Shldr, @ForeArm, @Hand, @Thigh, @Shin, @Foot, ;
Blender Rigify | L | R | spine.002 |
    spine 0.95, spine.001 1.07, spine.002 1.19, spine.003 1.3, neck 1.45, head 1.54,
    head.end 1.74 |
    shoulder.@, upper_arm.@, forearm.@, hand.@, thigh.@, shin.@, foot.@, toe.@;
Unreal | l | r | spine_02 |
    pelvis 0.95, spine_01 1.06, spine_02 1.19, spine_03 1.28, neck_01 1.45, head 1.54 |
    clavicle_@, upperarm_@, lowerarm_@, hand_@, thigh_@, calf_@, foot_@, ball_@;
VRM | L | R | J_Bip_C_Chest |
    J_Bip_C_Hips 0.97, J_Bip_C_Spine 1.03, J_Bip_C_Chest 1.15, J_Bip_C_UpperChest 1.27,
    J_Bip_C_Neck 1.43, J_Bip_C_Head 1.51 |
    J_Bip_@_Shoulder, J_Bip_@_UpperArm, J_Bip_@_LowerArm, J_Bip_@_Hand, J_Bip_@_UpperLeg,
    J_Bip_@_LowerLeg, J_Bip_@_Foot, J_Bip_@_ToeBase;
Biovision | Left | Right | Chest |
    Hips 0.97, Chest 1.12, Neck 1.42, Head 1.5, Head.end 1.72 |
    @Collar, @Shoulder, @Elbow, @Wrist, @Hip, @Knee, @Ankle, @Toe;
Acclaim | l | r | upperback |
    root 0.95, lowerback 1.02, upperback 1.14, thorax 1.26, lowerneck 1.4, upperneck 1.48,
    head 1.55, head.end 1.72 |
    @clavicle, @humerus, @radius, @wrist, @femur, @tibia, @foot, @toes;
MakeHuman | L | R | spine03 |
    root 0.95, spine05 0.98, spine04 1.07, spine03 1.17, spine02 1.27, spine01 1.35, neck01 1.43,
    neck02 1.47, neck03 1.51, head 1.55 |
    clavicle.@, upperarm01.@, lowerarm01.@, wrist.@, upperleg01.@, lowerleg01.@, foot.@, toe1-1.@;
MakeHuman, early | L | R | Spine2 |
    Root 0.95, Spine1 1.03, Spine2 1.16, Spine3 1.28, Neck 1.43, Head 1.54 |
    Clavicle_@, UpArm_@, LoArm_@, Hand_@, UpLeg_@, LoLeg_@, Foot_@, Toe_@;
Unity, VRChat | Left | Right | Chest |
    Hips 0.97, Spine 1.07, Chest 1.2, Neck 1.43, Head 1.54 |
    @ shoulder, @ arm, @ elbow, @ wrist, @ leg, @ knee, @ ankle, @ toe)";

std::vector<std::string> Split(absl::string_view text, char separator) {
  std::vector<std::string> parts;
  for (absl::string_view part : absl::StrSplit(text, separator)) {
    parts.emplace_back(absl::StripAsciiWhitespace(part));
  }
  return parts;
}

const std::vector<Convention>& AllConventions() {
  static const auto& all = *[] {
    auto* conventions = new std::vector<Convention>;
    for (const std::string& row : Split(kConventions, ';')) {
      const std::vector<std::string> cells = Split(row, '|');
      Convention c{cells[0], cells[1], cells[2], cells[3], {}, Split(cells[5], ',')};
      for (const std::string& joint : Split(cells[4], ',')) {
        const std::size_t space = joint.rfind(' ');
        c.middle[joint.substr(0, space)] = std::stof(joint.substr(space));
      }
      conventions->push_back(std::move(c));
    }
    return conventions;
  }();
  return all;
}

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
  std::vector<JointReading> readings;
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", tree, motion::SbuSkeleton(), {}, &readings);
  ASSERT_TRUE(map.ok()) << map.status();
  ExpectEveryJoint(MapPose(*map, tree, MakePose(GetParam())));
  EXPECT_THAT(JointNotes(readings), Contains(HasSubstr("torso: " + GetParam().torso + " (")));
}

TEST_P(Conventions, FindEveryJointWithoutAHierarchy) {
  const NamedPose pose = MakePose(GetParam());
  std::vector<JointReading> readings;
  const absl::StatusOr<JointMap> map =
      MapJoints("a.csv", pose.names, OneFrame(pose), motion::SbuSkeleton(), {}, &readings);
  ASSERT_TRUE(map.ok()) << map.status();
  ExpectEveryJoint(ApplyJointMap(*map, pose.positions));
  EXPECT_THAT(JointNotes(readings), Contains(HasSubstr("torso: " + GetParam().torso + " (")));
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
  if (GetParam().limbs[7].empty()) return;
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

INSTANTIATE_TEST_SUITE_P(All, Conventions, ::testing::ValuesIn(AllConventions()));

// Maps the only frame of a file without a hierarchy.
absl::StatusOr<JointMap> MapFrame(const NamedPose& pose,
                                  const motion::Skeleton& skeleton = motion::SbuSkeleton(),
                                  const JointOverrides& overrides = {},
                                  std::vector<JointReading>* readings = nullptr) {
  return MapJoints("a.bvh", pose.names, OneFrame(pose), skeleton, overrides, readings);
}

// Joints at x = 0, 1, ..., and the x of each joint of the skeleton.
NamedPose InARow(const std::vector<std::string>& names) {
  NamedPose pose{names, {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    pose.positions.push_back({static_cast<float>(i), 0, 0});
  }
  return pose;
}

std::vector<float> MapRow(const std::vector<std::string>& names, const motion::Skeleton& skeleton,
                          const JointOverrides& overrides = {}) {
  const NamedPose pose = InARow(names);
  const absl::StatusOr<JointMap> map = MapFrame(pose, skeleton, overrides);
  EXPECT_THAT(map, IsOk());
  std::vector<float> mapped;
  if (!map.ok()) return mapped;
  for (const motion::Vec3& at : ApplyJointMap(*map, pose.positions)) mapped.push_back(at.x);
  return mapped;
}

motion::Skeleton SkeletonOf(const std::vector<std::string>& names) {
  motion::Skeleton skeleton;
  skeleton.joint_names = names;
  return skeleton;
}

// A file of Mixamo's, with another name for each joint whose name contains `part`.
NamedPose Renamed(const std::string& part, const std::string& name) {
  NamedPose pose = MakePose(AllConventions()[0]);
  for (std::string& joint : pose.names) {
    if (joint.find(part) != std::string::npos)
      joint = name + joint.substr(joint.find(part) + part.size());
  }
  return pose;
}

TEST(JointMapping, UsesTheSkeletonsOwnNames) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  std::vector<std::string> names = {"head.end"};
  names.insert(names.end(), skeleton.joint_names.rbegin(), skeleton.joint_names.rend());
  std::vector<float> wanted(15);
  for (int i = 0; i < 15; ++i) wanted[static_cast<std::size_t>(i)] = static_cast<float>(15 - i);
  EXPECT_EQ(MapRow(names, skeleton), wanted);
  // The user's joint has priority.
  names.push_back("marker");
  wanted[5] = 16;
  EXPECT_EQ(MapRow(names, skeleton, {{"left_hand", "marker"}}), wanted);
}

TEST(JointMapping, KeepsWristAndHandApart) {
  EXPECT_THAT(MapRow({"LeftWrist", "LeftHand"}, SkeletonOf({"left_hand", "left_wrist"})),
              ElementsAre(1, 0));
  // The file's hand is the wrist if the user names the hand.
  EXPECT_THAT(
      MapRow({"LeftForeArm", "LeftHand", "Knuckles"},
             SkeletonOf({"left_elbow", "left_wrist", "left_hand"}), {{"left_hand", "Knuckles"}}),
      ElementsAre(0, 1, 2));
}

TEST(JointMapping, LetsTheUserNameJoints) {
  const NamedPose pose = Renamed("mixamorig:LeftHand", "paw");
  const absl::StatusOr<JointMap> map =
      MapFrame(pose, motion::SbuSkeleton(), {{"left_hand", "paw"}, {"head", "mixamorig:Head"}});
  ASSERT_THAT(map, IsOk());
  const std::vector<motion::Vec3> mapped = ApplyJointMap(*map, pose.positions);
  EXPECT_NEAR(mapped[5].x, 0.72, 1e-5);
  EXPECT_NEAR(mapped[0].y, 1.55, 1e-5) << "a joint that the user names is taken as it is";
}

TEST(JointMapping, ReportsMissingJointsAndUnknownOverrides) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  EXPECT_THAT(MapFrame(Renamed("mixamorig:LeftHand", "paw")),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("a.bvh: joints: expected joints for left_hand, got none;"),
                             HasSubstr("paw"), HasSubstr("left_hand=NAME"))));
  const NamedPose pose = MakePose(AllConventions()[0]);
  EXPECT_THAT(MapFrame(pose, skeleton, {{"tail", "mixamorig:Hips"}}).status().message(),
              HasSubstr("joint map: target: expected one of"));
  EXPECT_THAT(MapFrame(pose, skeleton, {{"torso", "Nothing"}}).status().message(),
              HasSubstr("torso=Nothing: a.bvh has no such joint"));
  const NamedPose odd = InARow({"", ":", "_", "l", "Left", "\xff\xfe", "head", "head.end"});
  EXPECT_THAT(MapFrame(odd).status().message(), Not(HasSubstr("for head")));
}

TEST(JointMapping, InterpolatesTheTorsoIfNoSpineJointIsNear) {
  std::vector<JointReading> readings;
  ASSERT_THAT(MapFrame(Renamed("mixamorig:Spine", "bone"), motion::SbuSkeleton(), {}, &readings),
              IsOk());
  EXPECT_THAT(JointNotes(readings), Contains(HasSubstr("torso: half way")));
}

TEST(JointMapping, StraightensTheCharacterFromTheHierarchyOnly) {
  const absl::StatusOr<JointMap> map =
      MapJoints("a.bvh", MakeTree(AllConventions()[0]), motion::SbuSkeleton());
  ASSERT_THAT(map, IsOk());
  ASSERT_EQ(map->straight.size(), 15u);
  EXPECT_NEAR(Distance(map->straight[9], map->straight[10]), 0.42, 1e-5) << "thigh";
  EXPECT_NEAR(Distance(map->straight[3], map->straight[4]), 0.29, 1e-5) << "upper arm";
  EXPECT_NEAR(map->straight[2].y - map->straight[9].y, 0.26, 1e-5) << "torso above the hips";
}

TEST(JointMapping, SkipsTheHelpersOfMakeHuman) {
  JointTree tree = MakeTree(AllConventions()[0]);
  const auto helper = [&tree](const std::string& name, const std::string& joint) {
    const auto found = std::find(tree.names.begin(), tree.names.end(), joint);
    ASSERT_NE(found, tree.names.end());
    const auto at = found - tree.names.begin();
    const int parent = tree.parents[static_cast<std::size_t>(at)];
    // At its parent's place, and earlier in the file.
    tree.names.insert(tree.names.begin() + at, name);
    tree.parents.insert(tree.parents.begin() + at, parent);
    tree.offsets.insert(tree.offsets.begin() + at, Vec3d{});
    for (std::size_t j = static_cast<std::size_t>(at) + 1; j < tree.parents.size(); ++j) {
      if (tree.parents[j] >= at) ++tree.parents[j];
    }
  };
  const absl::StatusOr<JointMap> before = MapJoints("a.bvh", tree, motion::SbuSkeleton());
  ASSERT_THAT(before, IsOk());
  const std::size_t hip = 9;
  const std::string name =
      tree.names[static_cast<std::size_t>(before->sources[hip].terms[0].joint)];
  helper("__" + name, name);
  const absl::StatusOr<JointMap> map = MapJoints("a.bvh", tree, motion::SbuSkeleton());
  ASSERT_THAT(map, IsOk());
  EXPECT_EQ(tree.names[static_cast<std::size_t>(map->sources[hip].terms[0].joint)], name);
}

TEST(JointTable, ReadsOneJointPerLine) {
  const absl::StatusOr<JointOverrides> table = ParseJointTable(
      "\xEF\xBB\xBF# ours\r\n\r\nleft_hand=LeftWrist\r\n  torso = Chest 3 \r\nhead=a=b", "a.txt");
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_THAT(*table, ElementsAre(Pair("head", "a=b"), Pair("left_hand", "LeftWrist"),
                                  Pair("torso", "Chest 3")));
}

TEST(JointTable, NamesTheLineOfAnError) {
  for (const char* bad : {"head", "=Head", "head=", "head = "}) {
    const auto status = ParseJointTable(std::string("# one\n") + bad + "\n", "a.txt").status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << bad;
    EXPECT_THAT(std::string(status.message()),
                HasSubstr("a.txt:2: expected MODEL_JOINT=FILE_JOINT"))
        << bad;
  }
  EXPECT_THAT(std::string(ParseJointTable("head=a\nhead = b\n", "a.txt").status().message()),
              HasSubstr("a.txt:2: expected each joint once, got \"head\" twice"));
}

}  // namespace
}  // namespace duet::retargeting
