#include "model/motion/skeleton_json.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

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

}  // namespace
}  // namespace duet::motion
