#include "model/motion/skeleton.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "model/motion/body_part.h"
#include "model/motion/limb_lengths.h"
#include "model/motion/skeleton_json.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

TEST(SbuSkeleton, HasThePapersBones) {
  // Section 3.4, 1-based and without direction.
  const std::pair<int, int> paper[] = {{1, 2},   {2, 3},   {2, 4},   {2, 7},  {3, 10},
                                       {3, 13},  {4, 5},   {5, 6},   {7, 8},  {8, 9},
                                       {10, 11}, {11, 12}, {13, 14}, {14, 15}};
  const Skeleton skeleton = SbuSkeleton();
  EXPECT_EQ(skeleton.bones.size(), 14u);
  for (const auto& [a, b] : paper) {
    EXPECT_THAT(skeleton.bones, ::testing::AnyOf(::testing::Contains(Bone{a - 1, b - 1}),
                                                 ::testing::Contains(Bone{b - 1, a - 1})))
        << a << "-" << b;
  }
}

TEST(SbuSkeleton, LandmarksAreWhatTheyAreCalled) {
  const Skeleton skeleton = SbuSkeleton();
  EXPECT_EQ(skeleton.root, skeleton.Find("torso"));
  EXPECT_EQ(skeleton.hips, (JointPair{skeleton.Find("left_hip"), skeleton.Find("right_hip")}));
  EXPECT_EQ(skeleton.feet, (JointPair{skeleton.Find("left_foot"), skeleton.Find("right_foot")}));
}

TEST(Skeleton, HandsAreTheWristsIfItHasThem) {
  Skeleton skeleton = SbuSkeleton();
  EXPECT_EQ(FindHands(skeleton), (JointPair{5, 8}));
  skeleton.joint_names[1] = "left_wrist";
  EXPECT_EQ(FindHands(skeleton), (JointPair{5, 8}));  // one wrist is no pair
  skeleton.joint_names[2] = "right_wrist";
  EXPECT_EQ(FindHands(skeleton), (JointPair{1, 2}));
  skeleton.joint_names[1] = skeleton.joint_names[2] = skeleton.joint_names[5] = "other";
  EXPECT_FALSE(FindHands(skeleton).has_value());
}

TEST(Skeleton, IsRejectedByField) {
  const struct {
    std::function<void(Skeleton&)> how;
    const char* why;
  } cases[] = {
      {[](Skeleton& s) { s.joint_names.clear(); }, "joint_names: expected at least one joint"},
      {[](Skeleton& s) { s.joint_names[3] = ""; }, "joint_names: expected non-empty names"},
      {[](Skeleton& s) { s.joint_names[3] = "head"; }, "joint_names: \"head\" is repeated"},
      {[](Skeleton& s) { s.root = 15; }, "root: expected a joint index from 0 to 14, got 15"},
      {[](Skeleton& s) { s.hips->left = 99; }, "left_hip: expected a joint index"},
      {[](Skeleton& s) { s.feet->right = -1; }, "right_foot: expected a joint index"},
      {[](Skeleton& s) { s.bones.pop_back(); }, "bones: expected 14 to connect 15 joints, got 13"},
      {[](Skeleton& s) { s.bones[0].child = -2; }, "bones: expected a joint index from 0 to 14"},
      {[](Skeleton& s) { s.bones[0].parent = 2, s.bones[0].child = 3; },
       "expected one parent of joint 3, got another"},
      {[](Skeleton& s) { s.bones[6].parent = 4; }, "below the root, got it elsewhere"},
      {[](Skeleton& s) { s.bones[2].parent = 4; },  // shoulder <- elbow <- shoulder
       "below the root, got it elsewhere"}};
  for (const auto& one : cases) {
    Skeleton skeleton = SbuSkeleton();
    one.how(skeleton);
    EXPECT_THAT(Validate(skeleton),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(one.why)));
  }
}

TEST(SbuParts, AreFiveOfThreeJoints) {
  const std::vector<BodyPart> parts = SbuParts();
  EXPECT_THAT(Validate(parts, SbuSkeleton()), IsOk());
  ASSERT_EQ(parts.size(), 5u);
  std::vector<int> joints;
  for (const BodyPart& part : parts) {
    EXPECT_EQ(part.joints.size(), 3u) << part.name;
    joints.insert(joints.end(), part.joints.begin(), part.joints.end());
  }
  std::sort(joints.begin(), joints.end());
  EXPECT_THAT(joints, ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14));
}

TEST(BodyParts, AreRejectedByName) {
  const auto refused = [](const std::vector<BodyPart>& parts, const char* why) {
    EXPECT_THAT(Validate(parts, SbuSkeleton()),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why)));
  };
  refused({}, "parts: expected at least one, got none");
  refused({{"arm", {3}}, {"trunk", {}}}, "parts: expected at least one joint of \"trunk\"");
  refused({{"trunk", {0, 15}}}, "parts.trunk: expected a joint index from 0 to 14, got 15");
  refused({{"trunk", {-1}}}, "parts.trunk: expected a joint index from 0 to 14, got -1");
}

using nlohmann::json;

json Complete() { return json::parse(SkeletonToJson(SbuSkeleton(), SbuParts()).dump()); }

TEST(SkeletonJson, RoundTrip) {
  const absl::StatusOr<SkeletonDocument> read = ReadSkeleton(Complete(), "skeleton");
  ASSERT_THAT(read, IsOk());
  const Skeleton& got = read->skeleton;
  const Skeleton wanted = SbuSkeleton();
  EXPECT_EQ(got.joint_names, wanted.joint_names);
  EXPECT_EQ(got.bones, wanted.bones);
  EXPECT_EQ(got.root, wanted.root);
  EXPECT_EQ(got.hips, wanted.hips);
  EXPECT_EQ(got.feet, wanted.feet);
  EXPECT_EQ(read->parts, SbuParts());
}

TEST(SkeletonJson, LandmarksMayBeAbsentBothSidesTogether) {
  Skeleton skeleton = SbuSkeleton();
  skeleton.hips.reset();
  skeleton.feet.reset();
  const json bare = json::parse(SkeletonToJson(skeleton, SbuParts()).dump());
  const absl::StatusOr<SkeletonDocument> read = ReadSkeleton(bare, "skeleton");
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->skeleton.hips.has_value());
  EXPECT_FALSE(read->skeleton.feet.has_value());
  for (const char* field : {"left_hip", "right_hip", "left_foot", "right_foot"}) {
    json one_side = Complete();
    one_side.erase(field);
    EXPECT_THAT(ReadSkeleton(one_side, "skeleton"),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         HasSubstr(std::string("skeleton.") + field + ": missing")));
  }
}

TEST(SkeletonJson, RejectsByFieldAndPlace) {
  const struct {
    const char* pointer;
    const char* value;
    const char* why;
  } cases[] = {
      {"/joint_names/3", "\"head\"", "a.joint_names: \"head\" is repeated"},
      {"/bones/2", "[\"neck\"]",
       "a.bones[2]: expected a pair of joint names, parent first, got [\"neck\"]"},
      {"/bones/2/1", "\"tail\"", "a.bones[2]: expected one of skeleton.joint_names, got \"tail\""},
      {"/bones", "[]", "a.bones: expected 14 to connect 15 joints, got 0"},
      {"/parts/1/joints/0", "\"tail\"",
       "a.parts[1].joints: expected one of skeleton.joint_names, got \"tail\""},
      {"/parts/1/joints", "[]", "a.parts: expected at least one joint of \"right_arm\""},
      {"/parts/1/name", "\"left_arm\"", "a.parts[1].name: \"left_arm\" is repeated or reserved"},
      {"/parts/1/name", "\"a/b\"", "a.parts[1].name: expected 1 to 64 letters"},
      {"/parts", "[]", "a.parts: expected at least one, got none"},
      {"/root", "\"tail\"", "a.root: expected one of skeleton.joint_names, got \"tail\""},
      {"/left_hip", "3", "a.left_hip: expected a string"},
      {"/tail", "3", "unknown field \"tail\""},
  };
  for (const auto& one : cases) {
    json value = Complete();
    value[json::json_pointer(one.pointer)] = json::parse(one.value);
    EXPECT_THAT(ReadSkeleton(value, "a"),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(one.why)))
        << one.pointer << " " << one.value;
  }
}

// A chain of three joints, its bones listed child first.
Skeleton Chain() {
  Skeleton skeleton;
  skeleton.joint_names = {"root", "middle", "end"};
  skeleton.bones = {{1, 2}, {0, 1}};
  skeleton.root = 0;
  return skeleton;
}

TEST(LimbLengthsTest, MedianIsOverTheFrames) {
  const Poses poses(3, {{0, 0, 0},
                        {1, 0, 0},
                        {1, 2, 0},  // 2, 1
                        {0, 0, 0},
                        {3, 0, 0},
                        {3, 9, 0},  // 9, 3
                        {0, 0, 0},
                        {2, 0, 0},
                        {2, 3, 0}});  // 3, 2
  EXPECT_THAT(MedianBoneLengths(Chain(), poses), ElementsAre(FloatEq(3), FloatEq(2)));
}

TEST(LimbLengthsTest, SettingKeepsRootAndDirections) {
  Poses poses(3, {{1, 1, 1}, {1, 3, 1}, {5, 3, 1}});
  SetBoneLengths(Chain(), {0.5f, 1}, &poses);
  EXPECT_THAT(poses.all(), ElementsAre(Vec3{1, 1, 1}, Vec3{1, 2, 1}, Vec3{1.5f, 2, 1}));
}

TEST(LimbLengthsTest, BoneWithoutDirectionStaysPut) {
  Poses poses(3, {{1, 1, 1}, {1, 1, 1}, {1, 2, 1}});
  SetBoneLengths(Chain(), {3, 1}, &poses);
  EXPECT_THAT(poses.all(), ElementsAre(Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 4, 1}));
}

}  // namespace
}  // namespace duet::motion
