#include "model/formats/bvh/bvh_document.h"

#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/expect_near.h"
#include "tests/support/matchers.h"

namespace duet::formats::bvh {
namespace {

using test::ExpectNear;

// Other spacing, order and names than ours: what exporters write.
constexpr char kArm[] =
    "HIERARCHY\n"
    "ROOT Bip01 L UpperArm {\n"
    "\tOFFSET 1 2 3\n"
    "\tCHANNELS 6 Yrotation Xrotation Zrotation Zposition Yposition Xposition\n"
    "\tJOINT Fore Arm\n"
    "\t{\n"
    "\t\tOFFSET 10 0 0\n"
    "\t\tCHANNELS 1 zrotation\n"
    "\t\tEnd Site\n"
    "\t\t{\n"
    "\t\t\tOFFSET 0 0 5\n"
    "\t\t}\n"
    "\t}\n"
    "}\n"
    "MOTION\n"
    "Frames:\t2\n"
    "Frame Time: 0.04\n"
    "90 0 0 7 8 9 0\r\n"
    "0 0 90 0 0 0 90\n"
    "\n";

BvhDocument Parse(const std::string& text) {
  absl::StatusOr<BvhDocument> document = ParseBvh(text, "a.bvh");
  EXPECT_THAT(document, IsOk());
  return document.ok() ? *std::move(document) : BvhDocument();
}

std::string ParseError(const std::string& text) {
  const absl::StatusOr<BvhDocument> document = ParseBvh(text, "a.bvh");
  EXPECT_EQ(document.status().code(), absl::StatusCode::kInvalidArgument) << document.status();
  return std::string(document.status().message());
}

std::string ErrorWith(const std::string& from, const std::string& to) {
  EXPECT_THAT(kArm, HasSubstr(from));
  return ParseError(absl::StrReplaceAll(kArm, {{from, to}}));
}

TEST(BvhDocument, ReadsAnyHierarchy) {
  const BvhDocument document = Parse(kArm);
  ASSERT_EQ(document.joints.size(), 3u);
  EXPECT_EQ(document.joints[0].name, "Bip01 L UpperArm");
  EXPECT_EQ(document.joints[1].name, "Fore Arm");
  EXPECT_EQ(document.joints[2].name, "Fore Arm.end");
  EXPECT_TRUE(document.joints[2].end_site);
  EXPECT_EQ(document.joints[2].parent, 1);
  EXPECT_THAT(document.joints[1].channels, ElementsAre(BvhChannel::kZRotation));
  EXPECT_EQ(document.ChannelCount(), 7);
  EXPECT_EQ(document.frame_count, 2);
  EXPECT_DOUBLE_EQ(document.frame_time_s, 0.04);
}

TEST(BvhDocument, LinesMayEndWithCarriageReturnsAlone) {
  std::string text = absl::StrReplaceAll(kArm, {{"\r\n", "\r"}, {"\n", "\r"}});
  const BvhDocument document = Parse(text);
  EXPECT_EQ(document.joints[1].name, "Fore Arm");
  EXPECT_EQ(document.frame_count, 2);
  absl::StrReplaceAll({{"Frames:\t2", "Frames:\tx"}}, &text);
  EXPECT_THAT(ParseError(text), HasSubstr("a.bvh:16: "));
}

TEST(BvhDocument, AppliesChannelsInTheFilesOrder) {
  const BvhDocument document = Parse(kArm);
  // Yaw 90: +x goes to -z, +z to +x. The root stands where its channels say, not at OFFSET.
  std::vector<retargeting::Vec3d> at = PoseAt(document, 0).positions;
  ExpectNear(at[0], {9, 8, 7});
  ExpectNear(at[1], {9, 8, -3});
  ExpectNear(at[2], {14, 8, -3});
  at = PoseAt(document, 1).positions;
  ExpectNear(at[1], {0, 10, 0});
  ExpectNear(at[2], {0, 10, 5});
}

// Rx 90 after (inside) Rz 90 is not Rz 90 after Rx 90.
TEST(BvhDocument, PutsTheFirstChannelOutermost) {
  const auto end_of = [](const std::string& channels) {
    const BvhDocument document = Parse(absl::StrCat(
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2 ", channels,
        "\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 1\n90 90\n"));
    return PoseAt(document, 0).positions[1];
  };
  ExpectNear(end_of("Zrotation Xrotation"), {0, 0, 1});
  ExpectNear(end_of("Xrotation Zrotation"), {-1, 0, 0});
}

TEST(BvhDocument, PositionChannelsBelowTheRootReplaceOffset) {
  const BvhDocument document = Parse(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT b\n{\nOFFSET 0 10 0\n"
      "CHANNELS 3 Xposition Yposition Zposition\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 1\n0 10.5 0\n");
  ExpectNear(PoseAt(document, 0).positions[2], {0, 11.5, 0});
}

TEST(BvhDocument, WritesWhatItReads) {
  const BvhDocument document = Parse(kArm);
  const std::string text = FormatBvh(document);
  const absl::StatusOr<BvhDocument> again = ParseBvh(text, "b.bvh");
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(FormatBvh(*again), text);
  EXPECT_EQ(again->values, document.values);
  EXPECT_EQ(again->joints[1].name, "Fore Arm");
}

TEST(BvhDocument, IgnoresAByteOrderMark) {
  const BvhDocument document = Parse(absl::StrCat("\xEF\xBB\xBF", kArm));
  EXPECT_EQ(document.values, ParseBvh(kArm, "a.bvh")->values);
}

TEST(BvhDocument, NamesThePlaceOfAnError) {
  EXPECT_THAT(ErrorWith("HIERARCHY", "hello"),
              HasSubstr("a.bvh:1: expected HIERARCHY at the start of a BVH file, got \"hello\""));
  EXPECT_THAT(ErrorWith("OFFSET 10 0 0", "OFFSET 10 x 0"),
              HasSubstr("a.bvh:7: expected a number of OFFSET x y z, got \"x\""));
  EXPECT_THAT(ErrorWith("OFFSET 10 0 0", ""),
              HasSubstr("joint \"Fore Arm\": expected an OFFSET, got none"));
  EXPECT_THAT(ErrorWith("CHANNELS 1 z", "CHANNELS 7 z"),
              HasSubstr("a.bvh:8: expected a number of channels, 0 to 6, got \"7\""));
  EXPECT_THAT(ErrorWith("CHANNELS 1 z", "CHANNELS 1 w"), HasSubstr("got \"wrotation\""));
  EXPECT_THAT(ErrorWith("Xrotation", "Yrotation"),
              HasSubstr("channel Yrotation: expected once per joint, got twice"));
  EXPECT_THAT(ErrorWith("JOINT Fore Arm", "JOINT"),
              HasSubstr("a.bvh:5: JOINT: expected a name, got none"));
  EXPECT_THAT(ErrorWith("End Site", "End"), HasSubstr("End: expected a name, got none"));
  EXPECT_THAT(ErrorWith("ROOT", "JOINT"), HasSubstr("expected ROOT"));
  EXPECT_THAT(ErrorWith("Frames:\t2", "Frames: 0"),
              HasSubstr("a.bvh:16: expected a number of frames, 1 to 200000, got \"0\""));
  EXPECT_THAT(ErrorWith("Frames:\t2", "Frames: 999999999"), HasSubstr("a number of frames"));
  EXPECT_THAT(ErrorWith("Time: 0.04", "Time: 0"), HasSubstr("a frame time of"));
  EXPECT_THAT(ErrorWith("90 0 0 7 8 9 0", "90 0 0 7 8 9"),
              HasSubstr("a.bvh:18: expected 7 channel values, got 6"));
  EXPECT_THAT(ErrorWith("90 0 0 7 8 9 0", "90 0 0 7 8 nan 0"),
              HasSubstr("a.bvh:18: channel value 6: expected a finite number, got \"nan\""));
  EXPECT_THAT(ErrorWith("Frames:\t2", "Frames: 4"),
              HasSubstr("expected the 4 frames of Frames:, got 2"));
  const std::string row = "0 0 90 0 0 0 90\n";
  EXPECT_THAT(ParseError(absl::StrCat(kArm, row, row)),
              HasSubstr("a.bvh:22: expected the 2 frames of Frames:, got at least 2 more"));
}

TEST(BvhDocument, RejectsEndlessNesting) {
  std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n";
  for (int i = 0; i < 100000; ++i) text += "JOINT a\n{\nOFFSET 0 0 0\n";
  EXPECT_THAT(ParseError(text), HasSubstr("expected at most 1024 joints, got more"));
}

TEST(BvhDocument, ReadsSeveralRoots) {
  const std::string root = "{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n}\n";
  const BvhDocument document =
      Parse(absl::StrCat("HIERARCHY\nROOT a\n", root, "ROOT b\n", root,
                         "MOTION\nFrames: 1\nFrame Time: 1\n1 2 3 4 5 6\n"));
  ExpectNear(PoseAt(document, 0).positions[1], {4, 5, 6});
}

}  // namespace
}  // namespace duet::formats::bvh
