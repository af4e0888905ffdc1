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
  EXPECT_THAT(checks[0].text, HasSubstr("in 2 frames, first in 7"));
}

TEST(CheckSkeleton, SizeAcceptsLegsOfSevenTenthsToOnePointFourMetres) {
  const double leg = motion::LegLength(Sbu(), MakePerson().poses);
  const std::pair<double, bool> lengths[] = {
      {0.69, false}, {0.71, true}, {1.39, true}, {1.41, false}};
  for (const auto& [metres, good] : lengths) {
    motion::Clip clip = MakePerson();
    for (motion::Vec3& at : clip.poses.all()) at = at * static_cast<float>(metres / leg);
    EXPECT_EQ(Find(CheckSkeleton(clip, Sbu()), "size").good, good) << metres;
  }
}

// Moves one joint of every frame.
void MoveJoint(motion::Clip* clip, const char* joint,
               motion::Vec3 (*to)(const motion::Clip&, int)) {
  for (int frame = 0; frame < clip->frame_count(); ++frame) {
    clip->at(frame, Sbu().Find(joint)) = to(*clip, frame);
  }
}

// Moves everything from a frame on.
void Shift(motion::Clip* clip, int from, motion::Vec3 by) {
  for (int frame = from; frame < clip->frame_count(); ++frame) {
    for (motion::Vec3& at : clip->poses[frame]) at += by;
  }
}

TEST(CheckSkeleton, EachCheckNamesWhatItFinds) {
  const struct {
    const char* check;
    const char* text;
    void (*spoil)(motion::Clip*);
  } cases[] = {
      {"limb lengths", "most left_elbow to left_hand",
       [](motion::Clip* clip) {
         MoveJoint(clip, "left_hand", [](const motion::Clip& of, int frame) {
           const motion::Vec3 hand = of.at(frame, Sbu().Find("left_hand"));
           const motion::Vec3 along = hand - of.at(frame, Sbu().Find("left_elbow"));
           return hand + along * (static_cast<float>(frame) / static_cast<float>(of.frame_count()));
         });
       }},
      {"limb lengths", "left_shoulder to left_elbow has no length",
       [](motion::Clip* clip) {
         MoveJoint(clip, "left_elbow", [](const motion::Clip& of, int frame) {
           return of.at(frame, Sbu().Find("left_shoulder"));
         });
       }},
      {"floor", "above for 66.7 % of the time",
       [](motion::Clip* clip) {
         Shift(clip, 20, {0, 1, 0});
       }},
      {"floor", "a foot gets",
       [](motion::Clip* clip) { clip->at(30, Sbu().feet->left).y -= 0.5f; }},
      {"jumps", "in 1 frames, first 12",
       [](motion::Clip* clip) {
         Shift(clip, 12, {2, 0, 0});
       }},
      {"sides", "knees and elbows bend the wrong way (100 %",
       [](motion::Clip* clip) { SwapSides(clip, 0, clip->frame_count() - 1); }},
      {"sides", "shoulders are opposite to those of the hips", [](motion::Clip* clip) {
         for (const char* joint : {"shoulder", "elbow", "hand"}) {
           const int left = Sbu().Find(std::string("left_") + joint);
           const int right = Sbu().Find(std::string("right_") + joint);
           for (int frame = 0; frame < clip->frame_count(); ++frame) {
             std::swap(clip->at(frame, left), clip->at(frame, right));
           }
         }
       }}};
  for (const auto& one : cases) {
    motion::Clip clip = MakePerson();
    one.spoil(&clip);
    const SkeletonCheck check = Find(CheckSkeleton(clip, Sbu()), one.check);
    EXPECT_FALSE(check.good) << one.text;
    EXPECT_THAT(check.text, HasSubstr(one.text));
  }
}

TEST(CheckSkeleton, JumpsAreNotCheckedWithoutAFrameRate) {
  motion::Clip clip = MakePerson();
  clip.frame_rate_hz = 0;
  for (const SkeletonCheck& check : CheckSkeleton(clip, Sbu())) EXPECT_NE(check.name, "jumps");
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
