#include <gmock/gmock.h>

#include "model/dataset/dataset.h"
#include "tests/support/matchers.h"

namespace duet::dataset {

bool operator==(const LabelSpan& a, const LabelSpan& b) {
  return a.interaction_class == b.interaction_class && a.begin == b.begin && a.end == b.end;
}

namespace {

constexpr char kHeader[] = "path\tclass\tfrom_seconds\tto_seconds\n";
const std::vector<std::string> kClasses = {"basic", "turn"};

TEST(ParseTimeLinesTest, ReadsSpansInFramesSortedByTheirBeginning) {
  const auto time_lines = ParseTimeLines(std::string(kHeader) +
                                             "b.txt\tturn\t1\t1.5\r\n"
                                             "a.txt\tturn\t0.5\t2\n"
                                             "\n"
                                             "a.txt\tbasic\t0\t1.04\n",
                                         kClasses, 10);
  ASSERT_THAT(time_lines, IsOk());
  ASSERT_EQ(time_lines->size(), 2u);
  EXPECT_THAT(time_lines->at("a.txt"), ElementsAre(LabelSpan{0, 0, 10}, LabelSpan{1, 5, 20}));
  EXPECT_THAT(time_lines->at("b.txt"), ElementsAre(LabelSpan{1, 10, 15}));
}

struct BadLine {
  std::string text;
  std::string message;
};

class ParseTimeLinesErrorTest : public testing::TestWithParam<BadLine> {};

TEST_P(ParseTimeLinesErrorTest, NamesLineColumnExpectedAndActual) {
  EXPECT_THAT(ParseTimeLines(GetParam().text, kClasses, 10),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    , ParseTimeLinesErrorTest,
    testing::Values(BadLine{"", "labels.tsv:1: header: expected"},
                    BadLine{"path\tclass\n", "got no from_seconds"},
                    BadLine{std::string(kHeader) + "a.txt\tturn\t1\n",
                            "labels.tsv:2: columns: expected 4, got 3"},
                    BadLine{std::string(kHeader) + "a.txt\tdip\t1\t2\n",
                            ":2: class: expected one of basic, turn, got \"dip\""},
                    BadLine{std::string(kHeader) + "a.txt\tturn\tsoon\t2\n",
                            "from_seconds: expected seconds from 0 to 1e+06, got \"soon\""},
                    BadLine{std::string(kHeader) + "a.txt\tturn\tnan\t2\n", "from_seconds"},
                    BadLine{std::string(kHeader) + "a.txt\tturn\t-1\t2\n", "from_seconds"},
                    BadLine{std::string(kHeader) + "a.txt\tturn\t0\t1e9\n", "to_seconds"},
                    BadLine{std::string(kHeader) + "a.txt\tturn\t2\t2.01\n",
                            "expected at least one frame after from_seconds 2, got 2.01"}));

// Frame t of a take has its only joint at x = t (leader) and x = 100 + t (follower).
Sequence Take(int frames) {
  Sequence take;
  take.id = "take.txt";
  take.subjects = {"take"};
  take.pair.leader.joint_names = take.pair.follower.joint_names = {"root"};
  for (int t = 0; t < frames; ++t) {
    const float x = static_cast<float>(t);
    take.pair.leader.Append({{x, 0, 0}});
    take.pair.follower.Append({{100 + x, 0, 0}});
  }
  return take;
}

TEST(CutIntoWindowsTest, TheLastWindowEndsWithTheSequence) {
  const std::vector<Sequence> windows = CutIntoWindows(Take(11), 4, 3);
  ASSERT_EQ(windows.size(), 4u);
  const std::vector<float> begins = {0, 3, 6, 7};
  for (size_t i = 0; i < windows.size(); ++i) {
    EXPECT_EQ(windows[i].pair.leader.frame_count(), 4);
    EXPECT_EQ(windows[i].pair.follower.frame_count(), 4);
    EXPECT_EQ(windows[i].pair.leader.at(0, 0).x, begins[i]);
    EXPECT_EQ(windows[i].pair.follower.at(3, 0).x, 103 + begins[i]);
    EXPECT_THAT(windows[i].subjects, ElementsAre("take"));
  }
  EXPECT_EQ(windows[2].id, "take.txt#6");
}

TEST(CutIntoWindowsTest, AWindowHasItsPartOfTheTimeLine) {
  Sequence take = Take(12);
  take.labels = {{0, 0, 5}, {1, 3, 8}};
  const std::vector<Sequence> windows = CutIntoWindows(take, 4, 4);
  ASSERT_EQ(windows.size(), 2u) << "frames 8 to 12 have no class";
  EXPECT_THAT(windows[0].labels, ElementsAre(LabelSpan{0, 0, 4}, LabelSpan{1, 3, 4}));
  EXPECT_EQ(windows[0].interaction_class, 0);
  EXPECT_THAT(windows[1].labels, ElementsAre(LabelSpan{0, 0, 1}, LabelSpan{1, 0, 4}));
  EXPECT_EQ(windows[1].interaction_class, 1);
}

}  // namespace
}  // namespace duet::dataset
