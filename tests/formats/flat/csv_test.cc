#include "model/formats/flat/csv.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/test_motion.h"

namespace duet::formats::flat {
namespace {

using ::testing::HasSubstr;

constexpr char kOnePerson[] =
    "# made by hand: fps=25, unit=millimetres; up_axis=z\n"
    "time,neck_x,head_x,head_y,head_z,neck_z,neck_y\n"
    "0.00,1,2,3,4,5,6\r\n"
    "0.04,-1,-2,-3,+4e1,-5,-6\n";

std::string ParseError(const std::string& text) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv(text, "a.csv");
  EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument) << motion.status();
  return std::string(motion.status().message());
}

TEST(Csv, ReadsColumnsInAnyOrder) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv(kOnePerson, "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 1u);
  const motion::Clip& clip = motion->people[0];
  EXPECT_THAT(clip.joint_names, ::testing::ElementsAre("neck", "head"));
  EXPECT_EQ(clip.frame_rate_hz, 25);
  ASSERT_EQ(clip.frame_count(), 2);
  EXPECT_EQ(clip.at(0, 0), (motion::Vec3{1, 6, 5}));
  EXPECT_EQ(clip.at(1, 1), (motion::Vec3{-2, -3, 40}));
  EXPECT_EQ(motion->coordinates.unit, motion::LengthUnit::kMillimetres);
  EXPECT_EQ(motion->coordinates.up_axis, motion::UpAxis::kZUp);
}

TEST(Csv, ReadsQuotedFieldsAndAByteOrderMark) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseCsv("\xEF\xBB\xBF\"frame\",\"a_x\", \"a_y\" ,a_z\n\"0\",\"1\", \"-2.5\" ,3\n", "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_THAT(motion->people[0].joint_names, ::testing::ElementsAre("a"));
  EXPECT_EQ(motion->people[0].at(0, 0), (motion::Vec3{1, -2.5f, 3}));
}

TEST(Csv, ReadsTodaysAndEarlierAxes) {
  for (const char* axis : {"y-down", "-y"}) {
    const absl::StatusOr<motion::RecordedMotion> motion =
        ParseCsv(absl::StrCat("# up_axis=", axis, "\na_x,a_y,a_z\n1,2,3\n"), "a.csv");
    ASSERT_TRUE(motion.ok()) << motion.status();
    EXPECT_EQ(motion->coordinates.up_axis, motion::UpAxis::kYDown) << axis;
  }
}

TEST(Csv, LeavesTheRateOpenWhereTheFileHasNone) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv("a_x,a_y,a_z\n1,2,3\n", "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->people[0].frame_rate_hz, 0);
  EXPECT_EQ(motion->coordinates.unit, motion::LengthUnit::kMetres);
  EXPECT_EQ(motion->coordinates.up_axis, motion::UpAxis::kYUp);
}

TEST(Csv, ReadsBackAPairExactly) {
  motion::ClipPair pair{test::MakePerson(), test::MakePerson({60, 3, 0, {0, 1, 1.2f}, 30})};
  pair.leader.frame_rate_hz = pair.follower.frame_rate_hz = 29.97;
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv(FormatCsv(pair), "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 2u);
  EXPECT_EQ(motion->people[0].joint_names, pair.leader.joint_names);
  EXPECT_EQ(motion->people[0].poses, pair.leader.poses);
  EXPECT_EQ(motion->people[1].poses, pair.follower.poses);
  EXPECT_EQ(motion->people[1].frame_rate_hz, 29.97);
  EXPECT_THAT(FormatCsv(pair),
              ::testing::StartsWith("# duet motion: frame_rate_hz=29.97 unit=metres "
                                    "up_axis=y-up\nframe,leader.head_x,"));
}

TEST(Csv, NamesThePlaceOfABadValue) {
  for (const char* bad : {"nan", "inf", "x", "", "1e20", "1;5"}) {
    EXPECT_THAT(ParseError(absl::StrReplaceAll(kOnePerson, {{"+4e1", bad}})),
                HasSubstr("a.csv:4: column 5: came"))
        << bad;
  }
}

TEST(Csv, RefusesARowOfAnotherLength) {
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2\n"), HasSubstr("a.csv:2: came 2 values, wanted 3"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2,3,\n"), HasSubstr("came 4 values"));
}

TEST(Csv, RefusesAHeaderThatDescribesNoJoints) {
  EXPECT_THAT(ParseError("a_x,a_y\n1,2\n"), HasSubstr("no column a_z"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z,a_x\n1,2,3,4\n"), HasSubstr("column 4: \"a_x\" comes twice"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z,speed\n1,2,3,4\n"), HasSubstr("column 4: came \"speed\""));
  EXPECT_THAT(ParseError("frame\n1\n"), HasSubstr("no joint columns"));
  EXPECT_THAT(ParseError("leader.a_x,leader.a_y,leader.a_z,b_x,b_y,b_z\n1,2,3,4,5,6\n"),
              HasSubstr("wanted one kind"));
  EXPECT_THAT(ParseError("follower.a_x,follower.a_y,follower.a_z\n1,2,3\n"),
              HasSubstr("no leader columns"));
}

TEST(Csv, RefusesSettingsThatItDoesNotKnow) {
  EXPECT_THAT(ParseError("# fps=0\na_x,a_y,a_z\n1,2,3\n"), HasSubstr("fps: came \"0\""));
  EXPECT_THAT(ParseError("# unit=feet\na_x,a_y,a_z\n1,2,3\n"),
              HasSubstr("unit: came \"feet\", wanted metres, "));
  EXPECT_THAT(ParseError("# up_axis=x\na_x,a_y,a_z\n1,2,3\n"),
              HasSubstr("up_axis: came \"x\", wanted y-up, z-up or y-down"));
}

TEST(Csv, RefusesAnEmptyFile) {
  EXPECT_THAT(ParseError(""), HasSubstr("no header line"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n"), HasSubstr("no frames"));
}

}  // namespace
}  // namespace duet::formats::flat
