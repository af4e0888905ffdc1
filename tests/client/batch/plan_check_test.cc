#include "client/batch/plan_check.h"

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "client/batch/manifest.h"
#include "client/batch/recipe.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

// Two items of each leader.
constexpr char kRecipe[] = R"(
  reactions { labels { weights { key: "kick" value: 1 } } }
  reactions { labels { weights { key: "hug" value: 1 } } }
  output { formats: FORMAT_NPY %s })";

ModelInfo Model() {
  ModelInfo model;
  model.name = "fake";
  model.version = 3;
  model.interaction_classes = {"kick", "hug"};
  model.joint_names = motion::SbuSkeleton().joint_names;
  return model;
}

RequestLimits Limits() {
  RequestLimits limits;
  limits.min_frame_rate_hz = 1;
  limits.max_frame_rate_hz = 240;
  limits.min_frames = 2;
  limits.max_duration = absl::Seconds(10);
  return limits;
}

class PlanCheckTest : public ::testing::Test {
 protected:
  PlanCheckTest() {
    Write("a.csv", 5, 15);
    Write("b.csv", 10, 30);
    Write("still.csv", 1, 15);
    Write("fast.csv", 5, 500);
    Write("long.csv", 200, 15);
  }

  void Write(const char* name, int frames, double rate_hz) {
    motion::Clip clip;
    clip.joint_names = motion::SbuSkeleton().joint_names;
    clip.frame_rate_hz = rate_hz;
    clip.poses = test::SwayingMotion(frames, rate_hz);
    ASSERT_THAT(
        formats::WritePeople(folder_ / name, formats::Format::kCsv, {clip}, motion::SbuSkeleton()),
        IsOk());
  }

  absl::StatusOr<PlanCheck> Check(const std::string& manifest, const PlanPart& part = {}) {
    std::string text = kRecipe;
    text.replace(text.find("%s"), 2, output_);
    const absl::StatusOr<Recipe> recipe = ParseRecipe(text, false);
    EXPECT_THAT(recipe, IsOk());
    std::istringstream in(manifest);
    absl::StatusOr<Plan> plan =
        Plan::Create(*recipe, {Model()}, ReadManifest(in, folder_.path(), "m"));
    EXPECT_THAT(plan, IsOk());
    return CheckPlan(*recipe, {motion::SbuSkeleton()}, Limits(), part, &*plan, stopped_);
  }

  test::TemporaryFolder folder_;
  std::string output_;
  std::function<bool()> stopped_ = [] { return false; };
};

TEST_F(PlanCheckTest, CountsWhatARunWouldMake) {
  const auto check = Check("leader\na.csv\nb.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->items, 4);
  EXPECT_EQ(check->leaders, 2);
  EXPECT_EQ(check->frames, 2 * (5 + 10));
  EXPECT_NEAR(check->seconds, 2 * (5 / 15.0 + 10 / 30.0), 1e-9);
  EXPECT_EQ(check->bad_line_count + check->bad_leader_count, 0);
  ASSERT_TRUE(check->first_item.has_value());
  EXPECT_EQ(check->first_item->number, 0);
  EXPECT_THAT(BadLinesError(*check), IsOk());
}

TEST_F(PlanCheckTest, CountsFramesAtTheRateOfTheSet) {
  output_ = "frame_rate_hz: 30";
  const auto check = Check("leader\na.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->frames, 2 * 9);  // from 0 to 4/15 s
}

TEST_F(PlanCheckTest, EveryBadLineIsNamedWithAllItsFields) {
  const auto check = Check(
      "leader\tlabels\tseed\tmodel\tside\n"
      "a.csv\twaltz=1\t\t\t\n"
      "b.csv\tkick\t-1\t\tup\n"
      "a.csv\tkick=1\t7\tother\t\n"
      "b.csv\tkick=1\n"
      "a.csv\tkick=1\t7\tfake@3\tleft\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->bad_line_count, 4);
  EXPECT_THAT(check->bad_lines,
              ElementsAre("m:2: labels: expected classes of fake@3 (kick, hug), got \"waltz\"",
                          AllOf(StartsWith("m:3: labels: expected CLASS=WEIGHT"),
                                HasSubstr("; side: expected left or right, got \"up\"; seed: ")),
                          "m:4: model: expected one of the recipe's (fake@3), got \"other\"",
                          "m:5: columns: expected 5 as the first line names, got 2"));
  EXPECT_EQ(check->items, 1);
  EXPECT_THAT(BadLinesError(*check),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("4 bad lines; no call was made:\n  m:2: labels"),
                             HasSubstr("\n  m:5: columns"))));
}

TEST_F(PlanCheckTest, IdOfABadLineIsReserved) {
  const auto check = Check("leader\tid\tseed\na.csv\tx\t-1\nb.csv\tx\t1\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_THAT(check->bad_lines,
              ElementsAre(HasSubstr("m:2: seed"),
                          "m:3: id: expected one that no other line has, got \"x\""));
}

TEST_F(PlanCheckTest, ManifestWithoutAHeaderIsOneBadLine) {
  const auto check = Check("a.csv\nb.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->bad_line_count, 1);
  EXPECT_THAT(check->bad_lines, ElementsAre(HasSubstr("m:1: columns: expected leader")));
}

TEST_F(PlanCheckTest, BadLeadersAreNamedOnceInTheOrderOfTheList) {
  const auto check = Check(
      "leader\nlong.csv\na.csv\nstill.csv\nnone.csv\nfast.csv\nstill.csv\nnone.csv\nnone.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->bad_leader_count, 4);
  ASSERT_THAT(check->bad_leaders, SizeIs(4));
  EXPECT_THAT(check->bad_leaders[0].message,
              AllOf(HasSubstr("long.csv: duration: expected at most 10 s, got 13.3333 s")));
  EXPECT_THAT(check->bad_leaders[1].message,
              EndsWith("still.csv: frames: expected at least 2, got 1"));
  EXPECT_EQ(check->bad_leaders[1].items, 4);
  EXPECT_THAT(check->bad_leaders[2].message, HasSubstr("none.csv: no such file"));
  EXPECT_EQ(check->bad_leaders[2].items, 6);
  EXPECT_THAT(check->bad_leaders[3].message,
              HasSubstr("fast.csv: frame rate: expected 1 to 240 Hz, got 500"));
  EXPECT_EQ(check->items_of_bad_leaders, 2 + 4 + 6 + 2);
  EXPECT_EQ(check->first_item->leader->given, "a.csv");
}

TEST_F(PlanCheckTest, LeadersOutsideThePartAreNotRead) {
  PlanPart part;
  part.limit = 2;
  const auto check = Check("leader\na.csv\nnone.csv\n", part);
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->items, 2);
  EXPECT_EQ(check->bad_leader_count, 0);
  // Lines are checked all the same.
  const auto whole = Check("leader\tseed\na.csv\t1\nb.csv\tx\n", part);
  ASSERT_THAT(whole, IsOk());
  EXPECT_EQ(whole->bad_line_count, 1);
}

TEST_F(PlanCheckTest, OnlyLeadersOfUnsettledItemsAreRead) {
  PlanPart part;
  part.is_settled = [](const Item& item) { return item.number < 4; };
  const auto check = Check("leader\nnone.csv\na.csv\nstill.csv\n", part);
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->items, 6);
  ASSERT_THAT(check->bad_leaders, SizeIs(1));
  EXPECT_THAT(check->bad_leaders[0].message, HasSubstr("still.csv"));
}

// A bad line shifts the numbers of the items after it, so they cannot be compared with a journal.
TEST_F(PlanCheckTest, ItemsAfterABadLineAreNotSurveyed) {
  std::vector<int64_t> surveyed;
  PlanPart part;
  part.is_settled = [&surveyed](const Item& item) {
    surveyed.push_back(item.number);
    return true;
  };
  const auto check = Check("leader\tseed\na.csv\t1\nb.csv\tx\nnone.csv\t2\n", part);
  ASSERT_THAT(check, IsOk());
  EXPECT_THAT(surveyed, ElementsAre(0, 1));
  EXPECT_EQ(check->bad_line_count, 1);
  EXPECT_EQ(check->bad_leader_count, 1);
}

TEST_F(PlanCheckTest, ErrorOfTheSurveyEndsTheCheck) {
  PlanPart part;
  part.is_settled = [](const Item&) { return absl::FailedPreconditionError("changed"); };
  EXPECT_THAT(Check("leader\na.csv\n", part),
              StatusIs(absl::StatusCode::kFailedPrecondition, "changed"));
}

TEST_F(PlanCheckTest, ReportsWhetherThePartHasAllItems) {
  PlanPart part;
  EXPECT_TRUE(Check("leader\na.csv\n", part)->whole_plan);
  part.limit = 2;
  EXPECT_TRUE(Check("leader\na.csv\n", part)->whole_plan);
  EXPECT_FALSE(Check("leader\na.csv\nb.csv\n", part)->whole_plan);
  part.limit = 100;
  part.share = 0.5;
  EXPECT_FALSE(Check("leader\na.csv\n", part)->whole_plan);
}

TEST_F(PlanCheckTest, StoppedCheckReadsNoMoreLeaders) {
  stopped_ = [] { return true; };
  const auto check = Check("leader\nnone.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_THAT(check->bad_leaders, IsEmpty());
  EXPECT_EQ(check->items, 0);
}

}  // namespace
}  // namespace duet::client::batch
