#include "model/formats/flat/csv.h"

#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::flat {
namespace {

constexpr char kOnePerson[] =
    "# made by hand: fps=25, unit=millimetres; up_axis=z-up\n"
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
  EXPECT_THAT(clip.joint_names, ElementsAre("neck", "head"));
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
  EXPECT_THAT(motion->people[0].joint_names, ElementsAre("a"));
  EXPECT_EQ(motion->people[0].at(0, 0), (motion::Vec3{1, -2.5f, 3}));
}

TEST(Csv, ReadsWhatSpreadsheetsWrite) {
  const std::string rows = "frame;a_x;a_y;a_z\r\n0;1,5;-2,5;3\r\n";
  const std::string texts[] = {
      rows,
      "sep=;\r\n" + rows,
      "\xEF\xBB\xBFsep=;\n" + rows,
      "SEP=\t\n" + absl::StrReplaceAll(rows, {{";", "\t"}}),
      "sep=,\nframe,a_x,a_y,a_z\n0,\"1,5\",\"-2,5\",3\n",
  };
  for (const std::string& text : texts) {
    const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv(text, "a.csv");
    ASSERT_THAT(motion, IsOk()) << text;
    ASSERT_THAT(motion->people[0].joint_names, ElementsAre("a"));
    EXPECT_EQ(motion->people[0].at(0, 0), (motion::Vec3{1.5f, -2.5f, 3})) << text;
  }
}

TEST(Csv, BoundsTheLengthOfALine) {
  const std::string longest(std::size_t{5} << 20, ',');
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2,3\n" + longest),
              HasSubstr("a.csv:3: expected a line of at most 4194304 bytes, got 5242880"));
  EXPECT_THAT(ParseError(longest), HasSubstr("a.csv:1: expected a line of at most"));
}

TEST(Csv, RejectsAFrameNumberThatIsNone) {
  for (const char* number : {"nan", "NaN", "-inf", "Infinity"}) {
    EXPECT_THAT(ParseError(absl::StrCat("frame,a_x,a_y,a_z\n0,1,2,3\n", number, ",1,2,3\n")),
                HasSubstr(absl::StrCat("a.csv:3: column 1: frame number: expected a number, got \"",
                                       number, "\"")));
  }
}

TEST(Csv, ReturnsNoRateIfTheFileHasNone) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv("a_x,a_y,a_z\n1,2,3\n", "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->people[0].frame_rate_hz, 0);
  EXPECT_EQ(motion->coordinates.unit, motion::LengthUnit::kMetres);
  EXPECT_EQ(motion->coordinates.up_axis, motion::UpAxis::kYUp);
}

// head and neck of one person at two moments.
void ExpectHeadAndNeck(const std::string& text, double frame_rate_hz = 0) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv(text, "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status() << "\n" << text;
  ASSERT_EQ(motion->people.size(), 1u) << text;
  const motion::Clip& clip = motion->people[0];
  EXPECT_THAT(clip.joint_names, ElementsAre("head", "neck")) << text;
  ASSERT_EQ(clip.frame_count(), 2) << text;
  EXPECT_EQ(clip.at(0, 0), (motion::Vec3{1, 2, 3})) << text;
  EXPECT_EQ(clip.at(0, 1), (motion::Vec3{4, 5, 6})) << text;
  EXPECT_EQ(clip.at(1, 0), (motion::Vec3{7, 8, 9})) << text;
  EXPECT_EQ(clip.at(1, 1), (motion::Vec3{-4, -5, -6})) << text;
  EXPECT_EQ(clip.frame_rate_hz, frame_rate_hz) << text;
}

constexpr char kRows[] = "0,1,2,3,4,5,6\n1,7,8,9,-4,-5,-6\n";

TEST(Csv, ReadsAnIndexOfAnyName) {
  for (const char* index : {"", "frame", "Frame", "index", "Unnamed: 0"}) {
    ExpectHeadAndNeck(absl::StrCat(index, ",head_x,head_y,head_z,neck_x,neck_y,neck_z\n", kRows));
  }
}

TEST(Csv, ReadsAxesWithAnySeparator) {
  for (const char* header :
       {"head_X,head_Y,head_Z,neck_X,neck_Y,neck_Z", "head.x,head.y,head.z,neck.x,neck.y,neck.z",
        "head x,head y,head z,neck x,neck y,neck z", "headX,headY,headZ,neckX,neckY,neckZ",
        "head_loc_x,head_loc_y,head_loc_z,neck_loc_x,neck_loc_y,neck_loc_z",
        "head.location.x,head.location.y,head.location.z,neck_pos_x,neck_pos_y,neck_pos_z"}) {
    ExpectHeadAndNeck(absl::StrCat("frame,", header, "\n", kRows));
  }
}

TEST(Csv, ReadsDecimalCommasUnlessCommasSeparate) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseCsv("time;a_x;a_y;a_z\n0,00;1,5;-2,25;3e-1\n", "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->people[0].at(0, 0), (motion::Vec3{1.5f, -2.25f, 0.3f}));
  EXPECT_THAT(ParseError("a_x;a_y;a_z\n1,500,000;2;3\n"), HasSubstr("got \"1,500,000\""));
}

TEST(Csv, ReadsSemicolonsAndTabs) {
  for (const char* delimiter : {";", "\t"}) {
    ExpectHeadAndNeck(absl::StrReplaceAll(
        absl::StrCat("frame,head_x,head_y,head_z,neck_x,neck_y,neck_z\n", kRows),
        {{",", delimiter}}));
  }
}

TEST(Csv, IgnoresAColumnOfTimes) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseCsv("time,a_x,a_y,a_z\n00:00,1,2,3\n00:01,1,2,3\n", "a.csv");
  ASSERT_THAT(motion, IsOk());
  EXPECT_EQ(motion->people[0].frame_count(), 2);
  EXPECT_EQ(motion->people[0].frame_rate_hz, 0);
}

TEST(Csv, RejectsEveryTruncationExceptInTheLastValue) {
  const std::string text = "frame,head_x,head_y,head_z\n0,1,2,3\n1,7,8,9";
  const std::size_t first_frame = text.find("0,1,2,3") + 7;
  for (std::size_t size = 0; size < text.size(); ++size) {
    const bool whole = size == first_frame || size == first_frame + 1;
    EXPECT_EQ(ParseCsv(text.substr(0, size), "a.csv").ok(), whole) << size;
  }
}

TEST(Csv, ReadsBackAPairExactly) {
  motion::ClipPair pair{test::MakePerson(), test::MakePerson({60, 3, 0, {0, 1, 1.2f}, 30})};
  pair.leader.frame_rate_hz = pair.follower.frame_rate_hz = 29.97;
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseCsv(FormatCsv({pair.leader, pair.follower}), "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->people.size(), 2u);
  EXPECT_EQ(motion->people[0].joint_names, pair.leader.joint_names);
  EXPECT_EQ(motion->people[0].poses, pair.leader.poses);
  EXPECT_EQ(motion->people[1].poses, pair.follower.poses);
  EXPECT_EQ(motion->people[1].frame_rate_hz, 29.97);
  EXPECT_THAT(FormatCsv({pair.leader, pair.follower}),
              ::testing::StartsWith("# duet motion: frame_rate_hz=29.97 unit=metres "
                                    "up_axis=y-up\nframe,leader.head_x,"));
}

TEST(Csv, NamesThePlaceOfABadValue) {
  for (const char* bad : {"nan", "inf", "x", "", "1e20", "1;5"}) {
    EXPECT_THAT(ParseError(absl::StrReplaceAll(kOnePerson, {{"+4e1", bad}})),
                HasSubstr("a.csv:4: column 5: expected a finite number"))
        << bad;
  }
}

TEST(Csv, RejectsARowOfAnotherLength) {
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2\n"),
              HasSubstr("a.csv:2: expected 3 values as in the header line, got 2"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2,3,\n"), HasSubstr("header line, got 4"));
}

TEST(Csv, RejectsAHeaderThatDescribesNoJoints) {
  EXPECT_THAT(ParseError("a_x,a_y\n1,2\n"), HasSubstr("a_z: expected one column, got 0"));
  EXPECT_THAT(ParseError("a\rb_x,a\rb_y\n1,2\n"),
              HasSubstr(R"(a\rb_z: expected one column, got 0)"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z,a_x\n1,2,3,4\n"),
              HasSubstr("column 4: expected a new name, got \"a_x\" again"));
  EXPECT_THAT(
      ParseError("a_x,a_y,a_z,speed\n1,2,3,4\n"),
      HasSubstr("column 4: expected frame, time or JOINT_x, JOINT_y, JOINT_z, got \"speed\""));
  EXPECT_THAT(ParseError("frame\n1\n"), HasSubstr("got no joint"));
  EXPECT_THAT(ParseError("leader.a_x,leader.a_y,leader.a_z,b_x,b_y,b_z\n1,2,3,4,5,6\n"),
              HasSubstr("or none, got both kinds"));
  EXPECT_THAT(ParseError("follower.a_x,follower.a_y,follower.a_z\n1,2,3\n"),
              HasSubstr("got only the follower's"));
}

TEST(Csv, RejectsUnknownSettings) {
  EXPECT_THAT(ParseError("# fps=0\na_x,a_y,a_z\n1,2,3\n"),
              HasSubstr("fps: expected more than 0 and at most 1000, got \"0\""));
  EXPECT_THAT(ParseError("# unit=feet\na_x,a_y,a_z\n1,2,3\n"),
              HasSubstr("unit: expected metres, "));
  EXPECT_THAT(ParseError("# up_axis=x\na_x,a_y,a_z\n1,2,3\n"),
              HasSubstr("up_axis: expected y-up, z-up or y-down, got \"x\""));
}

TEST(Csv, RejectsAnEmptyFile) {
  EXPECT_THAT(ParseError(""), HasSubstr("header: expected frame,head_x"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n"), HasSubstr("expected at least 1 frame"));
}

}  // namespace
}  // namespace duet::formats::flat
