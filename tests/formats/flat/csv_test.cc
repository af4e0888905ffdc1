#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/flat/flat_files.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::flat {
namespace {

constexpr char kOnePerson[] =
    "# made by hand: fps=25, unit=millimetres; up_axis=z-up\n"
    "time,neck_x,neck_y,neck_z,head_x,head_y,head_z\n"
    "0.00,1,6,5,2,3,4\r\n"
    "0.04,-1,-6,-5,-2,-3,+4e1\n";

std::string ParseError(const std::string& text) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv(text, "a.csv");
  EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument) << motion.status();
  return std::string(motion.status().message());
}

TEST(Csv, ReadsOnePersonAndItsComment) {
  // A spreadsheet begins a file with a byte order mark.
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseCsv(absl::StrCat("\xEF\xBB\xBF", kOnePerson), "a.csv");
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

TEST(Csv, BoundsTheLengthOfALine) {
  const std::string longest(std::size_t{5} << 20, ',');
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2,3\n" + longest),
              HasSubstr("a.csv:3: expected a line of at most 4194304 bytes, got 5242880"));
  EXPECT_THAT(ParseError(longest), HasSubstr("a.csv:1: expected a line of at most"));
}

TEST(Csv, ReturnsNoRateIfTheFileHasNone) {
  const absl::StatusOr<motion::RecordedMotion> motion = ParseCsv("a_x,a_y,a_z\n1,2,3\n", "a.csv");
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->people[0].frame_rate_hz, 0);
  EXPECT_EQ(motion->coordinates.unit, motion::LengthUnit::kMetres);
  EXPECT_EQ(motion->coordinates.up_axis, motion::UpAxis::kYUp);
}

TEST(Csv, IgnoresAColumnOfTimes) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      ParseCsv("time,a_x,a_y,a_z\n00:00,1,2,3\n00:01,1,2,3\n", "a.csv");
  ASSERT_THAT(motion, IsOk());
  EXPECT_EQ(motion->people[0].frame_count(), 2);
  EXPECT_EQ(motion->people[0].frame_rate_hz, 0);
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
                HasSubstr("a.csv:4: column 7: expected a finite number"))
        << bad;
  }
}

TEST(Csv, RejectsARowOfAnotherLength) {
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2\n"),
              HasSubstr("a.csv:2: expected 3 values as in the header line, got 2"));
  EXPECT_THAT(ParseError("a_x,a_y,a_z\n1,2,3,\n"), HasSubstr("header line, got 4"));
}

TEST(Csv, RejectsAHeaderThatDescribesNoJoints) {
  const std::pair<const char*, const char*> headers[] = {
      {"a_x,a_y", "column 1: expected JOINT_x, JOINT_y and JOINT_z side by side, got \"a_x\""},
      {"a\rb_x,a\rb_y", R"(got "a\rb_x")"},
      {"a_x,a_y,a_z,speed", "column 4: expected JOINT_x, JOINT_y and JOINT_z"},
      {"frame;a_x;a_y;a_z", "column 1: expected JOINT_x"},
      {"a_x,a_y,a_z,a_x,a_y,a_z", "column 4: expected another joint, got \"a_x\" again"},
      {"frame", "columns: expected JOINT_x, JOINT_y, JOINT_z, got none"},
      {"leader.a_x,leader.a_y,leader.a_z,b_x,b_y,b_z", "column 4: expected all columns without"},
      {"follower.a_x,follower.a_y,follower.a_z", "column 1: expected all columns without"}};
  for (const auto& [header, message] : headers) {
    EXPECT_THAT(ParseError(absl::StrCat(header, "\n1,2,3\n")), HasSubstr(message));
  }
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
