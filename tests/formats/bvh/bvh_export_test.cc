#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::bvh {
namespace {

using test::LargestDistance;
using test::MakePerson;
using test::PersonOptions;

using base::kPi;
constexpr float kOneMillimetre = 0.001f;

// The clip's joints again, in metres, from the document's text through forward kinematics.
motion::Clip PlayBack(const BvhDocument& written, const motion::Skeleton& skeleton) {
  const absl::StatusOr<BvhDocument> document = ParseBvh(FormatBvh(written), "written");
  EXPECT_TRUE(document.ok()) << document.status();
  motion::Clip clip;
  clip.joint_names = skeleton.joint_names;
  clip.frame_rate_hz = 1 / document->frame_time_s;
  for (int frame = 0; frame < document->frame_count; ++frame) {
    const std::vector<retargeting::Vec3d> positions = PoseAt(*document, frame).positions;
    std::vector<motion::Vec3> pose;
    for (const std::string& name : skeleton.joint_names) {
      for (std::size_t j = 0; j < positions.size(); ++j) {
        if (document->joints[j].name == name) pose.push_back(ToFloat(positions[j] * 0.01));
      }
    }
    clip.Append(pose);
  }
  return clip;
}

BvhDocument Export(const motion::Clip& clip) { return ToBvh(clip, motion::SbuSkeleton()); }

void ExpectPlaysBack(const motion::Clip& clip) {
  EXPECT_LT(LargestDistance(PlayBack(Export(clip), motion::SbuSkeleton()), clip), kOneMillimetre);
}

// The largest change of any joint's angle from one frame to the next, degrees.
float LargestStep(const BvhDocument& document) {
  const std::size_t channels = static_cast<std::size_t>(document.ChannelCount());
  float largest = 0;
  for (std::size_t i = channels; i < document.values.size(); ++i) {
    if (i % channels < 3) continue;  // the root's position
    largest = std::max(largest, std::abs(document.values[i] - document.values[i - channels]));
  }
  return largest;
}

class Facing : public ::testing::TestWithParam<double> {};

TEST_P(Facing, PlaysBackWithinAMillimetre) {
  PersonOptions options;
  options.yaw = GetParam() * kPi / 180;
  options.at = {3, 1.2f, -2};
  const motion::Clip clip = MakePerson(options);
  const BvhDocument document = Export(clip);
  EXPECT_LT(LargestDistance(PlayBack(document, motion::SbuSkeleton()), clip), kOneMillimetre);
  EXPECT_LT(LargestStep(document), 12) << "degrees a frame";
}

INSTANTIATE_TEST_SUITE_P(Degrees, Facing,
                         ::testing::Values(0, 45, 90, 135, 179.9, 180, 180.1, 225, 270, 315, 359));

TEST(BvhExport, TurnsThroughFullCirclesWithoutAJump) {
  for (double turns : {1.0, -1.0, 2.5}) {
    PersonOptions options;
    options.frames = 241;
    options.turn = 2 * kPi * turns;
    const motion::Clip clip = MakePerson(options);
    const BvhDocument document = Export(clip);
    EXPECT_LT(LargestDistance(PlayBack(document, motion::SbuSkeleton()), clip), kOneMillimetre);
    EXPECT_LT(LargestStep(document), 8) << turns << " turns, degrees a frame";
    // The root's Y channel carries the whole turn.
    const std::size_t channels = static_cast<std::size_t>(document.ChannelCount());
    EXPECT_NEAR(document.values[channels * 240 + 5] - document.values[5], 360 * turns, 20);
  }
}

// An arm that goes straight across the body passes the place where the shortest arc from the rest
// pose flips.
TEST(BvhExport, SwingsAnArmAcrossTheBodyWithoutAJump) {
  motion::Clip clip = MakePerson({121});
  for (int frame = 0; frame < 121; ++frame) {
    for (int j = 0; j < clip.joint_count(); ++j) clip.at(frame, j) = clip.at(0, j);
    // Horizontally, from forwards (+z) across the chest to the right (-x) and further back.
    const double angle = kPi * 1.2 * frame / 120;
    const motion::Vec3 along = motion::RotateY({0, 0, 1}, -angle);
    clip.at(frame, 4) = clip.at(frame, 3) + 0.29f * along;
    clip.at(frame, 5) = clip.at(frame, 4) + 0.28f * RotateY(along, -0.5);
  }
  const BvhDocument document = Export(clip);
  EXPECT_LT(LargestDistance(PlayBack(document, motion::SbuSkeleton()), clip), kOneMillimetre);
  EXPECT_LT(LargestStep(document), 15) << "degrees a frame";
}

// A rig's joints need not keep their distances: here the spine bends between the hips and the joint
// that stands for the torso. A joint is off by no more than the bones on its way from the root
// differ from their medians in that frame.
TEST(BvhExport, IsOffByNoMoreThanBonesVary) {
  motion::Clip clip = MakePerson({60});
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    clip.at(frame, 2).y += 0.05f * static_cast<float>(std::sin(0.3 * frame));
  }
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::vector<int> parents = skeleton.Parents();
  const auto length = [&](int frame, int joint) {
    return Distance(clip.at(frame, joint), clip.at(frame, parents[static_cast<size_t>(joint)]));
  };
  std::vector<float> medians(15);
  for (int joint = 0; joint < 15; ++joint) {
    if (joint == skeleton.root) continue;
    std::vector<float> lengths;
    for (int frame = 0; frame < 60; ++frame) lengths.push_back(length(frame, joint));
    std::nth_element(lengths.begin(), lengths.begin() + 30, lengths.end());
    medians[static_cast<size_t>(joint)] = lengths[30];
  }
  const motion::Clip played = PlayBack(Export(clip), skeleton);
  float largest = 0;
  for (int frame = 0; frame < 60; ++frame) {
    for (int joint = 0; joint < 15; ++joint) {
      const float off = Distance(played.at(frame, joint), clip.at(frame, joint));
      float allowed = kOneMillimetre;
      for (int j = joint; j != skeleton.root; j = parents[static_cast<size_t>(j)]) {
        allowed += std::abs(length(frame, j) - medians[static_cast<size_t>(j)]);
      }
      EXPECT_LT(off, allowed) << "frame " << frame << " "
                              << skeleton.joint_names[static_cast<size_t>(joint)];
      largest = std::max(largest, off);
    }
  }
  EXPECT_GT(largest, 0.03f) << "what the documents say of such leaders";
}

TEST(BvhExport, SurvivesJointsInOnePoint) {
  motion::Clip clip = MakePerson({3});
  for (motion::Vec3& p : clip.poses.all()) p = {1, 2, 3};
  ExpectPlaysBack(clip);
}

TEST(BvhExport, WritesWhatOtherProgramsExpect) {
  const std::string text = FormatBvh(Export(MakePerson({2})));
  EXPECT_THAT(text, HasSubstr("HIERARCHY\nROOT torso\n{\n  OFFSET 0.000000 0.000000 0.000000\n"
                              "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
                              "Yrotation\n"));
  EXPECT_THAT(text, HasSubstr("CHANNELS 3 Zrotation Xrotation Yrotation\n"));
  EXPECT_THAT(text, HasSubstr("MOTION\nFrames: 2\nFrame Time: 0.033333333\n"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace duet::formats::bvh
