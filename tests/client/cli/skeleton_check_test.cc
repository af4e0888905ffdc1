#include "client/cli/skeleton_check.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/motion/inferred_coordinates.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::client::cli {
namespace {

using test::MakePerson;

const motion::Skeleton& Sbu() {
  static const auto& skeleton = *new motion::Skeleton(motion::SbuSkeleton());
  return skeleton;
}

SkeletonCheck Find(const std::vector<SkeletonCheck>& checks, const std::string& name) {
  for (const SkeletonCheck& check : checks) {
    if (check.name == name) return check;
  }
  ADD_FAILURE() << "no check of " << name;
  return {};
}

// What is wrong with a person after `spoil`; every other check stays good.
SkeletonCheck Spoilt(const std::string& name, void (*spoil)(motion::Clip*)) {
  motion::Clip clip = MakePerson();
  spoil(&clip);
  const SkeletonCheck check = Find(CheckSkeleton(clip, Sbu()), name);
  EXPECT_FALSE(check.good) << check.text;
  return check;
}

void SwapSides(motion::Clip* clip, int first_frame, int last_frame) {
  for (int joint = 0; joint < clip->joint_count(); ++joint) {
    const std::string& name = clip->joint_names[static_cast<size_t>(joint)];
    if (name.rfind("left_", 0) != 0) continue;
    const int other = Sbu().Find("right_" + name.substr(5));
    for (int frame = first_frame; frame <= last_frame; ++frame) {
      std::swap(clip->at(frame, joint), clip->at(frame, other));
    }
  }
}

TEST(CheckSkeleton, PlausiblePersonPassesEveryCheck) {
  const std::vector<SkeletonCheck> checks = CheckSkeleton(MakePerson(), Sbu());
  std::vector<std::string> names;
  for (const SkeletonCheck& check : checks) {
    names.push_back(check.name);
    EXPECT_TRUE(check.good) << check.name << ": " << check.text;
  }
  EXPECT_THAT(names,
              ::testing::ElementsAre("finite", "size", "limb lengths", "floor", "jumps", "sides"));
}

TEST(CheckSkeleton, PositionThatIsNotFiniteEndsTheChecks) {
  motion::Clip clip = MakePerson();
  clip.at(7, 3).y = std::numeric_limits<float>::infinity();
  clip.at(9, 3).y = std::numeric_limits<float>::quiet_NaN();
  const std::vector<SkeletonCheck> checks = CheckSkeleton(clip, Sbu());
  ASSERT_EQ(checks.size(), 1u);
  EXPECT_FALSE(checks[0].good);
  EXPECT_EQ(checks[0].figures.at("bad_frames"), 2);
  EXPECT_THAT(checks[0].text, HasSubstr("in 2 frames, first in 7"));
}

TEST(CheckSkeleton, GiantFailsTheSizeCheck) {
  const SkeletonCheck check = Spoilt("size", [](motion::Clip* clip) {
    for (motion::Vec3& at : clip->poses.all()) at = at * 100;
  });
  EXPECT_GT(check.figures.at("foot_to_root_metres"), 70);
}

TEST(CheckSkeleton, SizeAcceptsLegsOfSevenTenthsToOnePointFourMetres) {
  const double leg = motion::LegLength(Sbu(), MakePerson().poses);
  const std::pair<double, bool> lengths[] = {
      {0.69, false}, {0.71, true}, {1.39, true}, {1.41, false}};
  for (const auto& [metres, good] : lengths) {
    motion::Clip clip = MakePerson();
    for (motion::Vec3& at : clip.poses.all()) at = at * static_cast<float>(metres / leg);
    const SkeletonCheck check = Find(CheckSkeleton(clip, Sbu()), "size");
    EXPECT_EQ(check.good, good) << check.text;
    EXPECT_NEAR(check.figures.at("foot_to_root_metres"), metres, 1e-4);
  }
}

TEST(CheckSkeleton, ALimbThatGrowsIsNamed) {
  const SkeletonCheck check = Spoilt("limb lengths", [](motion::Clip* clip) {
    const int elbow = Sbu().Find("left_elbow"), hand = Sbu().Find("left_hand");
    for (int frame = 0; frame < clip->frame_count(); ++frame) {
      const motion::Vec3 along = clip->at(frame, hand) - clip->at(frame, elbow);
      clip->at(frame, hand) += along * (static_cast<float>(frame) / clip->frame_count());
    }
  });
  EXPECT_THAT(check.text, HasSubstr("most left_elbow to left_hand"));
}

TEST(CheckSkeleton, ABoneWithoutLengthIsNamed) {
  const SkeletonCheck check = Spoilt("limb lengths", [](motion::Clip* clip) {
    const int shoulder = Sbu().Find("left_shoulder"), elbow = Sbu().Find("left_elbow");
    for (int frame = 0; frame < clip->frame_count(); ++frame) {
      clip->at(frame, elbow) = clip->at(frame, shoulder);
    }
  });
  EXPECT_THAT(check.text, HasSubstr("left_shoulder to left_elbow has no length"));
}

TEST(CheckSkeleton, FlyingPersonFailsTheFloorCheck) {
  const SkeletonCheck check = Spoilt("floor", [](motion::Clip* clip) {
    for (int frame = 20; frame < clip->frame_count(); ++frame) {
      for (motion::Vec3& at : clip->poses[frame]) at.y += 1;
    }
  });
  EXPECT_NEAR(check.figures.at("share_in_the_air"), 40.0 / 60, 0.01);
}

TEST(CheckSkeleton, FootBelowTheFloorIsDetected) {
  const SkeletonCheck check =
      Spoilt("floor", [](motion::Clip* clip) { clip->at(30, Sbu().feet->left).y -= 0.5f; });
  EXPECT_THAT(check.text, HasSubstr("a foot gets"));
}

TEST(CheckSkeleton, AJumpIsCountedAndPlaced) {
  const SkeletonCheck check = Spoilt("jumps", [](motion::Clip* clip) {
    for (int frame = 12; frame < clip->frame_count(); ++frame) {
      for (motion::Vec3& at : clip->poses[frame]) at.x += 2;
    }
  });
  EXPECT_EQ(check.figures.at("jumps"), 1);
  EXPECT_THAT(check.text, HasSubstr("first 12"));
}

TEST(CheckSkeleton, JumpsAreNotCheckedWithoutAFrameRate) {
  motion::Clip clip = MakePerson();
  clip.frame_rate_hz = 0;
  for (const SkeletonCheck& check : CheckSkeleton(clip, Sbu())) EXPECT_NE(check.name, "jumps");
}

TEST(CheckSkeleton, SidesThatAreSwappedThroughoutBendTheLimbsTheWrongWay) {
  const SkeletonCheck check =
      Spoilt("sides", [](motion::Clip* clip) { SwapSides(clip, 0, clip->frame_count() - 1); });
  EXPECT_EQ(check.figures.at("bent_wrongly"), 1);
  EXPECT_EQ(check.figures.at("swaps"), 0);
}

TEST(CheckSkeleton, SidesThatChangePlacesForAMomentAreCounted) {
  const SkeletonCheck check = Spoilt("sides", [](motion::Clip* clip) { SwapSides(clip, 10, 14); });
  EXPECT_EQ(check.figures.at("swaps"), 2);
}

TEST(CheckSkeleton, ShouldersThatAreSwappedOpposeTheHips) {
  const SkeletonCheck check = Spoilt("sides", [](motion::Clip* clip) {
    for (const char* joint : {"shoulder", "elbow", "hand"}) {
      const int left = Sbu().Find(std::string("left_") + joint);
      const int right = Sbu().Find(std::string("right_") + joint);
      for (int frame = 0; frame < clip->frame_count(); ++frame) {
        std::swap(clip->at(frame, left), clip->at(frame, right));
      }
    }
  });
  EXPECT_EQ(check.figures.at("shoulders_oppose_hips"), 1);
}

TEST(CheckSkeleton, ChecksWithoutTheirJointsAreOmitted) {
  motion::Skeleton rod;
  rod.joint_names = {"root", "tip"};
  rod.bones = {{0, 1}};
  motion::Clip clip;
  clip.joint_names = rod.joint_names;
  clip.frame_rate_hz = 30;
  clip.Append(std::vector<motion::Vec3>{{0, 0, 0}, {0, 1, 0}});
  for (const SkeletonCheck& check : CheckSkeleton(clip, rod)) {
    EXPECT_TRUE(check.name == "finite" || check.name == "limb lengths") << check.name;
  }
}

}  // namespace
}  // namespace duet::client::cli
