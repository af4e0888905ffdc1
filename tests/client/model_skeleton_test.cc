#include "client/model_skeleton.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client {
namespace {

ModelInfo Model(const std::vector<std::string>& joint_names) {
  ModelInfo model;
  model.name = "figure";
  model.joint_names = joint_names;
  model.root_joint = joint_names[0];
  for (int joint = 1; joint < static_cast<int>(joint_names.size()); ++joint) {
    model.bones.push_back({0, joint});
  }
  return model;
}

TEST(ToSkeleton, FindsLandmarksByName) {
  const auto skeleton =
      ToSkeleton(Model({"pelvis", "right_foot", "left_hip", "left_foot", "right_hip"}));
  ASSERT_THAT(skeleton, IsOk());
  EXPECT_EQ(skeleton->hips, (motion::JointPair{2, 4}));
  EXPECT_EQ(skeleton->feet, (motion::JointPair{3, 1}));
}

TEST(ToSkeleton, AnklesAreTheFeetOfAModelWithToes) {
  const auto skeleton =
      ToSkeleton(Model({"hips", "left_ankle", "left_toe", "right_ankle", "right_toe"}));
  EXPECT_EQ(skeleton->feet, (motion::JointPair{1, 3}));
  EXPECT_EQ(ToSkeleton(Model({"left_foot", "left_ankle", "right_foot", "right_ankle"}))->feet,
            (motion::JointPair{0, 2}));
}

TEST(ToSkeleton, LandmarksAreOptional) {
  const auto skeleton = ToSkeleton(Model({"thorax", "wing", "left_hip", "tail"}));
  ASSERT_THAT(skeleton, IsOk());
  EXPECT_FALSE(skeleton->hips.has_value());
  EXPECT_FALSE(skeleton->feet.has_value());
}

TEST(ToSkeleton, BonesThatAreNotATreeAreAnInternalError) {
  ModelInfo model = Model({"pelvis", "left_hip", "right_hip"});
  model.bones.pop_back();
  EXPECT_THAT(ToSkeleton(model),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("no usable skeleton: bones")));
}

}  // namespace
}  // namespace duet::client
