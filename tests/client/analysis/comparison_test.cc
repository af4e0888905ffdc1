#include "client/analysis/comparison.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::client::analysis {
namespace {

using test::MakePerson;

const motion::Skeleton& Sbu() {
  static const auto& skeleton = *new motion::Skeleton(motion::SbuSkeleton());
  return skeleton;
}

Comparison Compared(const Answer& a, const Answer& b) {
  const absl::StatusOr<Comparison> comparison = Compare(a, b, Sbu());
  EXPECT_THAT(comparison, IsOk());
  return comparison.value_or(Comparison{});
}

Figure FigureOf(const Comparison& comparison, const std::string& name) {
  for (const Figure& figure : comparison.figures) {
    if (figure.name == name) return figure;
  }
  ADD_FAILURE() << "no figure " << name;
  return {};
}

motion::Clip Moved(motion::Clip clip, motion::Vec3 by) {
  for (motion::Vec3& at : clip.poses.all()) at += by;
  return clip;
}

TEST(Compare, MotionHasNoDisplacementFromItself) {
  const Comparison same = Compared({MakePerson(), {}}, {MakePerson(), {}});
  EXPECT_EQ(same.frame_count, 60);
  EXPECT_FALSE(same.resampled);
  EXPECT_EQ(same.displacement.mean_metres, 0);
  EXPECT_EQ(same.displacement.most_metres, 0);
  for (const Figure& figure : same.figures) EXPECT_EQ(figure.a, figure.b) << figure.name;
}

TEST(Compare, StepAsideDisplacesOnlyTheRoot) {
  const Comparison moved = Compared({MakePerson(), {}}, {Moved(MakePerson(), {0.3f, 0, 0.4f}), {}});
  EXPECT_NEAR(moved.displacement.mean_metres, 0.5, 1e-5);
  EXPECT_NEAR(moved.displacement.root_metres, 0.5, 1e-5);
  EXPECT_NEAR(moved.displacement.root_aligned_metres, 0, 1e-5);
  EXPECT_NEAR(moved.displacement.velocity_metres_per_second, 0, 1e-4);
}

TEST(Compare, TheFarthestJointIsNamed) {
  motion::Clip odd = MakePerson();
  const int hand = Sbu().Find("right_hand");
  odd.at(17, hand).y += 2;
  const Displacement displacement = Compared({MakePerson(), {}}, {odd, {}}).displacement;
  EXPECT_NEAR(displacement.most_metres, 2, 1e-5);
  EXPECT_EQ(displacement.most_joint, "right_hand");
  EXPECT_EQ(displacement.most_frame, 17);
  EXPECT_NEAR(displacement.joint_metres[static_cast<size_t>(hand)], 2.0 / 60, 1e-5);
  EXPECT_EQ(displacement.joint_metres[0], 0);
}

TEST(Compare, RatesAndLengthsMayDiffer) {
  test::PersonOptions slow;
  slow.frames = 30;
  slow.frame_rate_hz = 15;
  const Comparison comparison = Compared({MakePerson(), {}}, {MakePerson(slow), {}});
  EXPECT_TRUE(comparison.resampled);
  EXPECT_EQ(comparison.frame_rate_hz, 30);
  EXPECT_EQ(comparison.frame_count, 59);  // 29 steps of 1/15 s
  EXPECT_LT(comparison.displacement.mean_metres, 0.02);
  EXPECT_NEAR(*FigureOf(comparison, "duration_seconds").b, 2, 1e-9);
}

TEST(Compare, PartnersAreComparedAndTouched) {
  const motion::Clip leader = Moved(MakePerson(), {0, 0, 1.5f});
  const Answer near{MakePerson(), Moved(MakePerson(), {0.1f, 0, 0})}, far{MakePerson(), leader};
  const Comparison comparison = Compared(near, far);
  EXPECT_GT(*comparison.partner_metres, 1.4);
  EXPECT_NEAR(*FigureOf(comparison, "root_distance_metres").b, 1.5, 1e-4);
  EXPECT_EQ(*FigureOf(comparison, "touch_share").a, 1);
  EXPECT_EQ(*FigureOf(comparison, "touch_share").b, 0);
  EXPECT_GT(*FigureOf(comparison, "penetration_metres").a, 0.05);
  EXPECT_EQ(*FigureOf(comparison, "penetration_metres").b, 0);
}

TEST(Compare, PersonWithoutPartnerHasNoContact) {
  const Comparison comparison =
      Compared({MakePerson(), {}}, {MakePerson(), Moved(MakePerson(), {0, 0, 1.5f})});
  EXPECT_EQ(comparison.partner_metres, std::nullopt);
  EXPECT_EQ(FigureOf(comparison, "touch_share").a, std::nullopt);
  EXPECT_TRUE(FigureOf(comparison, "touch_share").b.has_value());
}

TEST(Compare, LeanIsMeasured) {
  motion::Clip leaning = MakePerson();
  const int torso = Sbu().root;
  for (int frame = 0; frame < leaning.frame_count(); ++frame) {
    const motion::Vec3 root = leaning.at(frame, torso);
    for (motion::Vec3& at : leaning.poses[frame]) {
      at = root + RotateAbout(at - root, {1, 0, 0}, 0.7);
    }
  }
  const Comparison comparison = Compared({MakePerson(), {}}, {leaning, {}});
  const Figure lean = FigureOf(comparison, "mean_lean_degrees");
  EXPECT_GT(*lean.b, *lean.a + 15);
}

TEST(Compare, SingleFrameIsCompared) {
  motion::Clip one = MakePerson();
  one.poses.Resize(1);
  const Comparison comparison = Compared({one, {}}, {MakePerson(), {}});
  EXPECT_EQ(comparison.frame_count, 1);
  EXPECT_EQ(comparison.displacement.velocity_metres_per_second, 0);
}

TEST(Compare, PartnerWithOtherFrameCountIsRejected) {
  motion::Clip shorter = MakePerson();
  shorter.poses.Resize(10);
  EXPECT_THAT(Compare({MakePerson(), {}}, {MakePerson(), shorter}, Sbu()).status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("b: partner: frames: expected 60 as the person has, got 10")));
}

}  // namespace
}  // namespace duet::client::analysis
