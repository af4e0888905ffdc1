#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/formats/bvh/bvh_motion.h"
#include "tests/formats/bvh/rig_families.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::bvh {
namespace {

using test::RigFamily;

// Walks on the spot in a turn, arms and legs swinging; ankles as high as the rigs' are.
motion::Clip Follower() {
  test::PersonOptions options;
  options.frames = 120;
  options.yaw = 2;
  options.turn = 5;
  options.at = {0.4f, 1.13f, -0.8f};
  return test::MakePerson(options);
}

BvhDocument OntoRig(const motion::Clip& clip, const BvhDocument& rig) {
  absl::StatusOr<BvhDocument> written = OntoBvhRig(clip, rig, "rig.bvh", {});
  EXPECT_THAT(written.status(), IsOk());
  return written.value_or(BvhDocument());
}

// How a written file compares with the clip that it was written from.
struct Figures {
  double feet_metres = 0, hands_metres = 0;  // the largest distances
  double beyond_reach_metres = 0;            // of them, by what the longest arm is too short
  double hands_in_reach_metres = 0;          // what is left of the hands'
  double trunk_degrees = 0;                  // of the line between the shoulders
};

double Angle(motion::Vec3 a, motion::Vec3 b) {
  const double cosine = static_cast<double>(Dot(a, b) / (Norm(a) * Norm(b)));
  return base::kDegreesPerRadian * std::acos(std::clamp(cosine, -1.0, 1.0));
}

Figures Measure(const motion::Clip& clip, const BvhDocument& written) {
  Figures figures;
  const absl::StatusOr<motion::Clip> read = FromBvh(written, "written", {});
  EXPECT_THAT(read.status(), IsOk());
  if (!read.ok()) return figures;
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const auto find = [&](const char* name) { return skeleton.Find(name); };
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const auto apart = [&](const char* name) {
      return static_cast<double>(Distance(read->at(frame, find(name)), clip.at(frame, find(name))));
    };
    for (const std::string side : {"left", "right"}) {
      const auto at = [&](const motion::Clip& of, const char* joint) {
        return of.at(frame, find((side + joint).c_str()));
      };
      const motion::Vec3 shoulder = at(*read, "_shoulder"), elbow = at(*read, "_elbow"),
                         hand = at(*read, "_hand"), wanted = at(clip, "_hand");
      const double arm = static_cast<double>(Distance(shoulder, elbow) + Distance(elbow, hand));
      const double beyond = std::max(0.0, static_cast<double>(Distance(shoulder, wanted)) - arm);
      const double error = static_cast<double>(Distance(hand, wanted));
      figures.hands_metres = std::max(figures.hands_metres, error);
      figures.beyond_reach_metres = std::max(figures.beyond_reach_metres, beyond);
      figures.hands_in_reach_metres = std::max(figures.hands_in_reach_metres, error - beyond);
    }
    figures.feet_metres = std::max({figures.feet_metres, apart("left_foot"), apart("right_foot")});
    const auto shoulders = [&](const motion::Clip& of) {
      return of.at(frame, find("left_shoulder")) - of.at(frame, find("right_shoulder"));
    };
    figures.trunk_degrees =
        std::max(figures.trunk_degrees, Angle(shoulders(*read), shoulders(clip)));
  }
  return figures;
}

class BvhRig : public ::testing::TestWithParam<RigFamily> {};

TEST_P(BvhRig, TheFollowerStandsAndReachesOnTheRig) {
  const motion::Clip clip = Follower();
  const Figures figures = Measure(clip, OntoRig(clip, GetParam().document));
  EXPECT_LT(figures.feet_metres, 0.002);
  EXPECT_LT(figures.hands_in_reach_metres, 0.002);
  EXPECT_LT(figures.trunk_degrees, 8);
  std::printf("| %s | %.1f | %.1f | %.0f | %.1f |\n", GetParam().name.c_str(),
              figures.feet_metres * 1000, figures.hands_in_reach_metres * 1000,
              figures.beyond_reach_metres * 1000, figures.trunk_degrees);
}

TEST_P(BvhRig, KeepsHierarchyNamesOffsetsAndChannels) {
  const BvhDocument& rig = GetParam().document;
  const BvhDocument written = OntoRig(Follower(), rig);
  ASSERT_EQ(written.joints.size(), rig.joints.size());
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    EXPECT_EQ(written.joints[j].name, rig.joints[j].name);
    EXPECT_EQ(written.joints[j].parent, rig.joints[j].parent);
    EXPECT_EQ(written.joints[j].channels, rig.joints[j].channels);
    EXPECT_EQ(Norm(written.joints[j].offset - rig.joints[j].offset), 0);
  }
  EXPECT_EQ(written.frame_count, 120);
}

INSTANTIATE_TEST_SUITE_P(Families, BvhRig, ::testing::ValuesIn(test::RigFamilies()),
                         [](const ::testing::TestParamInfo<RigFamily>& family) {
                           std::string name = family.param.name;
                           name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                           return name;
                         });

TEST(OntoBvhRig, WritesOnlyTheChosenPersonOfAFileWithTwo) {
  const BvhDocument first = test::RigFamilies()[0].document;
  const BvhDocument second = test::RigFamilies()[1].document;
  BvhDocument both = first;
  for (BvhJoint joint : second.joints) {
    if (joint.parent >= 0) joint.parent += static_cast<int>(first.joints.size());
    both.joints.push_back(std::move(joint));
  }
  both.values.insert(both.values.end(), second.values.begin(), second.values.end());
  BvhImportOptions options;
  for (const BvhDocument& person : {first, second}) {
    const absl::StatusOr<BvhDocument> written = OntoBvhRig(Follower(), both, "rig.bvh", options);
    ASSERT_THAT(written, IsOk()) << options.person;
    ASSERT_EQ(written->joints.size(), person.joints.size()) << options.person;
    for (std::size_t j = 0; j < person.joints.size(); ++j) {
      EXPECT_EQ(written->joints[j].name, person.joints[j].name);
      EXPECT_EQ(written->joints[j].parent, person.joints[j].parent);
    }
    ++options.person;
  }
}

TEST(OntoBvhRig, RejectsARigThatCannotBeAPerson) {
  BvhDocument rig = test::RigFamilies()[1].document;
  for (BvhJoint& joint : rig.joints) {
    if (joint.name == "mixamorig:LeftForeArm") joint.channels.resize(1);
  }
  rig.values.resize(static_cast<std::size_t>(rig.ChannelCount()));
  EXPECT_THAT(std::string(OntoBvhRig(Follower(), rig, "rig.bvh", {}).status().message()),
              HasSubstr("\"mixamorig:LeftForeArm\": expected rotation channels about three axes"));
  motion::Clip other = Follower();
  for (std::string& name : other.joint_names) std::reverse(name.begin(), name.end());
  EXPECT_THAT(
      std::string(
          OntoBvhRig(other, test::RigFamilies()[0].document, "rig.bvh", {}).status().message()),
      HasSubstr("follower: joints: expected those of a person"));
  other.joint_names.pop_back();
  other.poses = motion::Poses(1, 14);
  EXPECT_THAT(
      std::string(
          OntoBvhRig(other, test::RigFamilies()[0].document, "rig.bvh", {}).status().message()),
      HasSubstr("expected the 15 joints that the rig is read for, got 14"));
}

}  // namespace
}  // namespace duet::formats::bvh
