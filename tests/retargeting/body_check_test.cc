#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/retargeting/character.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

class BodyCheckTest : public ::testing::Test {
 protected:
  BodyCheckTest() {
    for (std::size_t j = 0; j < skeleton_.joint_names.size(); ++j) {
      map_.sources.push_back({{{static_cast<int>(j), 1.0f}}});
      names_.push_back("File_" + skeleton_.joint_names[j]);
    }
  }

  // Moves `joint` to the place of `to` in every frame, or the part of the way.
  void Move(const std::string& joint, const std::string& to, float part) {
    for (int frame = 0; frame < clip_.frame_count(); ++frame) {
      motion::Vec3& at = clip_.at(frame, skeleton_.Find(joint));
      at = Lerp(at, clip_.at(frame, skeleton_.Find(to)), part);
    }
  }

  absl::Status Check() const { return CheckBody("a.bvh", skeleton_, clip_.poses, map_, names_); }

  const motion::Skeleton skeleton_ = motion::SbuSkeleton();
  motion::Clip clip_ = test::MakePerson();
  JointMap map_;
  std::vector<std::string> names_;
};

TEST_F(BodyCheckTest, AcceptsAPerson) {
  EXPECT_THAT(Check(), IsOk());
  EXPECT_THAT(UnequalBones(skeleton_, clip_.poses), IsEmpty());
}

TEST_F(BodyCheckTest, RejectsTwoHipsOrShouldersInOnePlace) {
  Move("left_hip", "right_hip", 1);
  EXPECT_THAT(Check(), StatusIs(absl::StatusCode::kInvalidArgument,
                                AllOf(HasSubstr("a.bvh: joints: expected left_hip and right_hip in "
                                                "two places, got File_left_hip and File_right_hip"),
                                      HasSubstr("joint map"))));
  clip_ = test::MakePerson();
  Move("left_shoulder", "right_shoulder", 1);
  EXPECT_THAT(Check().message(), HasSubstr("expected left_shoulder and right_shoulder"));
}

TEST_F(BodyCheckTest, ReportsBonesThatAreNotEqual) {
  Move("left_hand", "left_elbow", 0.5f);
  const std::vector<std::string> lines = UnequalBones(skeleton_, clip_.poses);
  EXPECT_THAT(lines, ElementsAre(HasSubstr("from elbow to hand on both sides")));
  Move("right_hand", "right_elbow", 0.5f);
  EXPECT_THAT(UnequalBones(skeleton_, clip_.poses), IsEmpty());
}

}  // namespace
}  // namespace duet::retargeting
