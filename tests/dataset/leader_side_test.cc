#include "model/dataset/leader_side.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"

namespace duet::dataset {
namespace {

TEST(LeaderIndexTest, ReadsSidesAndSubjectsByColumnName) {
  const auto index = ParseIndex(
      "frames\tleader_side\tpath\tsubjects\r\n"
      "12\tleft\ta.txt\tann, bob\r\n"
      "13\tright\tb.txt\t\r\n"
      "14\tunknown\tc.txt\tcy\r\n");
  ASSERT_TRUE(index.ok()) << index.status();
  EXPECT_EQ(index->at("a.txt").leader_side, LeaderSide::kLeft);
  EXPECT_THAT(index->at("a.txt").subjects, ElementsAre("ann", "bob"));
  EXPECT_EQ(index->at("b.txt").leader_side, LeaderSide::kRight);
  EXPECT_TRUE(index->at("b.txt").subjects.empty());
  EXPECT_EQ(index->at("c.txt").leader_side, LeaderSide::kUnknown);
  EXPECT_EQ(index->at("c.txt").line, 4);
}

TEST(LeaderIndexTest, NamesTheLineThatIsWrong) {
  const auto message = [](const std::string& text) {
    const auto index = ParseIndex(text);
    EXPECT_EQ(index.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(index.status().message());
  };
  EXPECT_THAT(message(""), HasSubstr("index.tsv:1: header: expected"));
  EXPECT_THAT(message("path\tside\n"), HasSubstr("path, leader_side, got no leader_side"));
  EXPECT_THAT(message("path\tleader_side\na\tleft\nb\n"),
              HasSubstr("index.tsv:3: columns: expected 2, got 1"));
  EXPECT_THAT(message("path\tleader_side\na\tLeft\n"),
              HasSubstr(":2: leader_side: expected left, right or unknown, got \"Left\""));
  EXPECT_THAT(message("path\tleader_side\na\tleft\na\tleft\n"),
              HasSubstr(":3: path: expected each once, got \"a\" again"));
}

// Two joints: a root that walks from `start` on, and a hand.
motion::Clip Walker(float hand_peak, float start = 0) {
  motion::Clip clip;
  clip.joint_names = {"root", "hand"};
  clip.frame_rate_hz = 15;
  for (const float reach : {0.0f, hand_peak, 0.0f}) {
    const float walked = start + 2 * static_cast<float>(clip.frame_count());
    clip.Append({{walked, 0, 0}, {walked + reach, 1, 0}});
  }
  return clip;
}

TEST(LeaderByMotionTest, ThePeakRelativeToTheRootDecides) {
  EXPECT_EQ(LeaderByMotion(Walker(0.5f), Walker(0.2f), 0, {1}), LeaderSide::kLeft);
  EXPECT_EQ(LeaderByMotion(Walker(0.2f), Walker(-0.5f), 0, {1}), LeaderSide::kRight);
}

TEST(LeaderByMotionTest, WhereSomebodyStandsIsNoReach) {
  EXPECT_EQ(LeaderByMotion(Walker(0.1f), Walker(0, 9), 0, {1}), LeaderSide::kLeft);
  EXPECT_EQ(LeaderByMotion(Walker(0, 9), Walker(0.1f), 0, {1}), LeaderSide::kRight);
}

}  // namespace
}  // namespace duet::dataset
