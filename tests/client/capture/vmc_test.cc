#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "client/capture/humanoid.h"
#include "client/capture/vmc_reader.h"
#include "client/capture/vmc_writer.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "tests/client/capture/datagrams.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::client::capture {
namespace {

constexpr float kMillimetre = 1e-3f;

const std::string& NameOf(std::size_t bone) {
  static const auto* const kReader = new VmcReader();
  return kReader->joint_names()[bone];
}

// The built-in person in the T pose, in Unity's axes.
std::vector<test::VmcBone> RestBones() {
  std::vector<test::VmcBone> bones;
  for (const HumanoidBone& bone : HumanoidBones()) {
    bones.push_back({bone.name,
                     {-static_cast<float>(bone.offset.x), static_cast<float>(bone.offset.y),
                      static_cast<float>(bone.offset.z)}});
  }
  return bones;
}

std::vector<test::VmcBone> Without(const std::string& name) {
  std::vector<test::VmcBone> bones;
  for (const test::VmcBone& bone : RestBones()) {
    if (bone.name != name) bones.push_back(bone);
  }
  return bones;
}

std::vector<CaptureFrame> ReadAll(VmcReader* reader, const std::vector<test::VmcFrame>& datagrams) {
  std::vector<CaptureFrame> frames;
  for (const test::VmcFrame& datagram : datagrams) {
    const absl::Status status = reader->Read(test::VmcDatagram(datagram), &frames);
    EXPECT_TRUE(status.ok()) << status;
  }
  return frames;
}

motion::Vec3 PositionOf(const CaptureFrame& frame, const std::string& name) {
  return frame.positions[static_cast<std::size_t>(FindHumanoidBone(name))];
}

motion::Vec3 RestPosition(const std::string& name) {
  return ToFloat(HumanoidRestPositions()[static_cast<std::size_t>(FindHumanoidBone(name))]);
}

TEST(VmcReaderTest, AddsUpTheBonesOfAFrame) {
  VmcReader reader;
  const auto frames = ReadAll(&reader, {{1.0f, RestBones()}, {2.0f, {}}});
  ASSERT_THAT(frames, SizeIs(1));
  EXPECT_EQ(frames[0].sender_seconds, 1.0);
  const auto rest = HumanoidRestPositions();
  for (std::size_t bone = 0; bone < kHumanoidBoneCount; ++bone) {
    EXPECT_LT(Distance(frames[0].positions[bone], ToFloat(rest[bone])), kMillimetre)
        << NameOf(bone);
  }
}

// The same bones with the names of VRM 1.0, and with those that files have.
TEST(VmcReaderTest, AcceptsTheNamesOfVrmAndOfFiles) {
  const std::vector<std::pair<std::string, std::string>> others = {{"LeftUpperArm", "LeftArm"},
                                                                   {"LeftLowerArm", "LeftForeArm"},
                                                                   {"LeftHand", "l_wrist"},
                                                                   {"RightUpperLeg", "RightUpLeg"},
                                                                   {"RightLowerLeg", "RightLeg"},
                                                                   {"RightFoot", "ankle.R"},
                                                                   {"RightToes", "RightToeBase"},
                                                                   {"Hips", "pelvis"},
                                                                   {"Head", "head"}};
  for (const auto& [bone, other] : others) {
    EXPECT_EQ(FindHumanoidBone(other), FindHumanoidBone(bone)) << other;
  }
  for (const HumanoidBone& bone : HumanoidBones()) {
    std::string vrm = bone.name;
    vrm[0] = static_cast<char>(vrm[0] + 'a' - 'A');
    EXPECT_EQ(FindHumanoidBone(vrm), FindHumanoidBone(bone.name)) << vrm;
  }
  for (const char* other : {"LeftEye", "Jaw", "LeftThumbProximal", "leftIndexDistal", "", "left"}) {
    EXPECT_EQ(FindHumanoidBone(other), -1) << other;
  }
  EXPECT_EQ(FindHumanoidBone("LeftShoulder"), 6) << "the collar bone, as in Unity";
}

// Unity is left-handed: a positive rotation about y turns from z towards x.
TEST(VmcReaderTest, TurnsChildrenWithTheirParentsInRightHandedAxes) {
  std::vector<test::VmcBone> bones = RestBones();
  const float half = std::sqrt(0.5f);
  bones[0].rotation[1] = half;  // hips, 90 degrees about y
  bones[0].rotation[3] = half;
  VmcReader reader;
  const auto frames = ReadAll(&reader, {{1.0f, bones}, {2.0f, {}}});
  ASSERT_THAT(frames, SizeIs(1));
  // In Unity, who faces +z then faces +x, and the left hand, at -x, comes to +z.
  const motion::Vec3 hand = PositionOf(frames[0], "LeftHand");
  EXPECT_NEAR(hand.x, 0, kMillimetre);
  EXPECT_NEAR(hand.z, RestPosition("LeftHand").x, kMillimetre);
  EXPECT_LT(PositionOf(frames[0], "LeftToes").x, PositionOf(frames[0], "LeftFoot").x - 0.1f);
}

TEST(VmcReaderTest, AFrameEndsWhenAllBonesOfTheFramesBeforeAreThere) {
  VmcReader reader;
  std::vector<test::VmcBone> upper = RestBones();
  const std::vector<test::VmcBone> lower(upper.begin() + 14, upper.end());
  upper.resize(14);
  EXPECT_THAT(ReadAll(&reader, {{1.0f, upper}, {std::nullopt, lower}}), SizeIs(0));
  EXPECT_THAT(ReadAll(&reader, {{2.0f, upper}}), SizeIs(1));
  const auto second = ReadAll(&reader, {{std::nullopt, lower}});
  ASSERT_THAT(second, SizeIs(1));
  EXPECT_EQ(second[0].sender_seconds, 2.0);
}

TEST(VmcReaderTest, AfterALostDatagramAFrameStillEndsWithItsLastOne) {
  VmcReader reader;
  std::vector<test::VmcBone> upper = RestBones();
  const std::vector<test::VmcBone> lower(upper.begin() + 14, upper.end());
  upper.resize(14);
  const test::VmcFrame legs = {std::nullopt, lower};
  const auto frames = ReadAll(&reader, {{1.0f, upper},
                                        legs,
                                        {2.0f, upper},
                                        legs,
                                        {3.0f, upper},  // the legs are lost
                                        {4.0f, upper},
                                        legs,
                                        {5.0f, upper},
                                        legs});
  ASSERT_THAT(frames, SizeIs(5));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sender_seconds, static_cast<double>(i) + 1);
  }
}

TEST(VmcReaderTest, ARepeatedBoneEndsAFrameWithoutATime) {
  VmcReader reader;
  const auto frames =
      ReadAll(&reader, {{std::nullopt, RestBones()}, {std::nullopt, {RestBones()[0]}}});
  ASSERT_THAT(frames, SizeIs(1));
  EXPECT_EQ(frames[0].sender_seconds, std::nullopt);
}

TEST(VmcReaderTest, ATimeIsThatOfOneFrameOnly) {
  VmcReader reader;
  const auto frames = ReadAll(
      &reader, {{1.0f, RestBones()}, {std::nullopt, RestBones()}, {std::nullopt, RestBones()}});
  ASSERT_THAT(frames, SizeIs(3));
  EXPECT_EQ(frames[0].sender_seconds, 1.0);
  EXPECT_EQ(frames[1].sender_seconds, std::nullopt);
}

TEST(VmcReaderTest, PositionsOfZeroAreThoseOfTheBuiltInPerson) {
  std::vector<test::VmcBone> bones = RestBones();
  for (test::VmcBone& bone : bones) {
    for (float& value : bone.position) value = 0;
  }
  VmcReader reader;
  const auto frames = ReadAll(&reader, {{1.0f, bones}, {2.0f, {}}});
  ASSERT_THAT(frames, SizeIs(1));
  for (std::size_t bone = 0; bone < kHumanoidBoneCount; ++bone) {
    EXPECT_LT(Distance(frames[0].positions[bone], RestPosition(NameOf(bone))), kMillimetre)
        << NameOf(bone);
  }
}

TEST(VmcReaderTest, ChildrenOfAMissingBoneAreChainedToItsParent) {
  std::vector<test::VmcBone> bones = Without("UpperChest");
  for (test::VmcBone& bone : bones) {  // the sender's chest is the parent of neck and shoulders
    if (bone.name == "Neck" || bone.name == "LeftShoulder" || bone.name == "RightShoulder") {
      bone.position[1] += 0.12f;
    }
  }
  VmcReader reader;
  const auto frames = ReadAll(&reader, {{1.0f, bones}, {2.0f, {}}});
  ASSERT_THAT(frames, SizeIs(1));
  for (const char* name : {"Neck", "Head", "LeftHand", "RightHand"}) {
    EXPECT_LT(Distance(PositionOf(frames[0], name), RestPosition(name)), kMillimetre) << name;
  }
  // The bone itself is between its neighbours.
  EXPECT_LT(Distance(PositionOf(frames[0], "UpperChest"), RestPosition("UpperChest")), kMillimetre);
}

TEST(VmcReaderTest, LegsThatNeverComeAreInTheRestPose) {
  std::vector<test::VmcBone> bones = RestBones();
  bones.resize(14);
  VmcReader reader;
  const auto frames = ReadAll(&reader, {{1.0f, bones}, {2.0f, {}}});
  ASSERT_THAT(frames, SizeIs(1));
  for (const char* name : {"LeftLowerLeg", "RightFoot", "RightToes"}) {
    EXPECT_LT(Distance(PositionOf(frames[0], name), RestPosition(name)), kMillimetre) << name;
  }
}

TEST(VmcReaderTest, NamesTheBonesThatNeverCame) {
  VmcReader reader;
  for (int i = 0; i < 40; ++i) {
    ReadAll(&reader, {{static_cast<float>(i), Without("UpperChest")}});
  }
  EXPECT_THAT(reader.TakeNotes(), ElementsAre(HasSubstr("leaves out UpperChest")));
  EXPECT_THAT(reader.TakeNotes(), SizeIs(0));
}

TEST(VmcReaderTest, ABoneThatIsLostKeepsItsTransform) {
  VmcReader reader;
  auto frames = ReadAll(&reader, {{1.0f, RestBones()}, {2.0f, Without("Chest")}, {3.0f, {}}});
  ASSERT_THAT(frames, SizeIs(2));
  EXPECT_LT(Distance(PositionOf(frames[1], "Head"), RestPosition("Head")), kMillimetre);
}

TEST(VmcReaderTest, RejectsTransformsThatAreNone) {
  for (const float value : {NAN, INFINITY, 2000.0f}) {
    VmcReader reader;
    std::vector<CaptureFrame> frames;
    const absl::Status status =
        reader.Read(test::VmcDatagram({1.0f, {{"Hips", {0, value, 0}}}}), &frames);
    EXPECT_THAT(std::string(status.message()), HasSubstr("a position within 1000 m"));
  }
}

TEST(VmcReaderTest, ManyRepeatedBonesAreABoundedNumberOfFrames) {
  test::VmcFrame frame;
  frame.bones.resize(700, RestBones()[0]);
  VmcReader reader;
  EXPECT_LE(ReadAll(&reader, {frame}).size(), std::size_t{kMaxFramesInDatagram});
}

// The follower of a model, sent and received again.
TEST(VmcWriterTest, WhatIsSentIsReceivedWithinACentimetre) {
  test::PersonOptions options;
  options.yaw = 0.7;
  options.turn = 2;
  options.at = {0.4f, 1.1f, -0.3f};
  const motion::Clip person = test::MakePerson(options);
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  VmcWriter writer(skeleton.joint_names, person.frame_rate_hz);
  VmcReader reader;
  std::vector<CaptureFrame> frames;
  for (int t = 0; t < person.frame_count(); ++t) {
    const auto datagrams = writer.Write(person.poses[t], t / person.frame_rate_hz);
    ASSERT_TRUE(datagrams.ok()) << datagrams.status();
    for (const std::string& datagram : *datagrams) {
      EXPECT_LE(datagram.size(), VmcWriter::kMaxBundleBytes);
      ASSERT_TRUE(reader.Read(datagram, &frames).ok());
    }
  }
  // The first frame ends with the time of the second.
  ASSERT_THAT(frames, SizeIs(static_cast<std::size_t>(person.frame_count())));
  const motion::Poses first(static_cast<int>(kHumanoidBoneCount), frames[0].positions);
  const auto map = retargeting::MapJoints("the stream", reader.joint_names(), first, skeleton);
  ASSERT_TRUE(map.ok()) << map.status();
  for (int t = 0; t < person.frame_count(); ++t) {
    const CaptureFrame& frame = frames[static_cast<std::size_t>(t)];
    EXPECT_NEAR(*frame.sender_seconds, t / person.frame_rate_hz, 1e-4);
    const std::vector<motion::Vec3> back = ApplyJointMap(*map, frame.positions);
    for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
      EXPECT_LT(Distance(back[static_cast<std::size_t>(joint)], person.at(t, joint)), 0.01f)
          << "frame " << t << ", " << skeleton.joint_names[static_cast<std::size_t>(joint)];
    }
  }
}

// A receiver that applies rotations only, as avatars do, gets the same pose in its own proportions.
TEST(VmcWriterTest, RotationsAloneGiveThePose) {
  const motion::Clip person = test::MakePerson({});
  VmcWriter writer(person.joint_names, person.frame_rate_hz);
  const auto datagrams = writer.Write(person.poses[20], 0);
  ASSERT_TRUE(datagrams.ok()) << datagrams.status();
  VmcReader as_sent, rotations_only;
  std::vector<CaptureFrame> sent, turned;
  for (std::string datagram : *datagrams) {
    ASSERT_TRUE(as_sent.Read(datagram, &sent).ok());
    // Positions of zero make the reader use its built-in person.
    for (std::size_t at = datagram.find("Bone/Pos"); at != std::string::npos;
         at = datagram.find("Bone/Pos", at + 1)) {
      const std::size_t name = at + 23;
      const std::size_t position = name + (std::strlen(datagram.c_str() + name) / 4 + 1) * 4;
      for (std::size_t i = 0; i < 12; ++i) datagram[position + i] = '\0';
    }
    ASSERT_TRUE(rotations_only.Read(datagram, &turned).ok());
  }
  const std::string end = test::VmcDatagram({9.0f, {}});
  ASSERT_TRUE(as_sent.Read(end, &sent).ok());
  ASSERT_TRUE(rotations_only.Read(end, &turned).ok());
  ASSERT_THAT(sent, SizeIs(1));
  ASSERT_THAT(turned, SizeIs(1));
  const std::pair<const char*, const char*> limbs[] = {
      {"LeftUpperArm", "LeftLowerArm"},   {"LeftLowerArm", "LeftHand"},
      {"RightUpperArm", "RightLowerArm"}, {"LeftUpperLeg", "LeftLowerLeg"},
      {"RightLowerLeg", "RightFoot"},     {"Neck", "Head"}};
  for (const auto& [from, to] : limbs) {
    const motion::Vec3 a = PositionOf(sent[0], to) - PositionOf(sent[0], from);
    const motion::Vec3 b = PositionOf(turned[0], to) - PositionOf(turned[0], from);
    EXPECT_GT(Dot(a, b) / (Norm(a) * Norm(b)), 0.99f) << from;
  }
}

TEST(VmcWriterTest, NamesTheJointsThatAFollowerLacks) {
  VmcWriter writer({"head", "left_hand"}, 30);
  const std::vector<motion::Vec3> pose(2);
  const auto datagrams = writer.Write(pose, 0);
  EXPECT_EQ(datagrams.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(datagrams.status().message()), HasSubstr("right_hand"));
}

}  // namespace
}  // namespace duet::client::capture
