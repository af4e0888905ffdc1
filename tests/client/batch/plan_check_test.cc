#include "client/batch/plan_check.h"

#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "client/batch/leaders.h"
#include "client/batch/recipe.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

// Two items of each leader.
constexpr char kRecipe[] = R"(
  reactions { labels { weights { key: "kick" value: 1 } } }
  reactions { labels { weights { key: "hug" value: 1 } } }
  output { formats: FORMAT_NPY })";

ModelInfo Model() {
  ModelInfo model;
  model.name = "fake";
  model.version = 3;
  model.interaction_classes = {"kick", "hug"};
  model.joint_names = motion::SbuSkeleton().joint_names;
  return model;
}

class PlanCheckTest : public ::testing::Test {
 protected:
  absl::StatusOr<PlanCheck> Check(const std::string& manifest, const PlanPart& part = {}) {
    const absl::StatusOr<Recipe> recipe = ParseRecipe(kRecipe, false);
    EXPECT_THAT(recipe, IsOk());
    std::istringstream in(manifest);
    absl::StatusOr<Plan> plan = Plan::Create(*recipe, {Model()}, ReadManifest(in, "", "m"));
    EXPECT_THAT(plan, IsOk());
    return CheckPlan(part, &*plan, visit_, stopped_);
  }

  std::function<absl::Status(const Item&)> visit_ = [](const Item&) { return absl::OkStatus(); };
  std::function<bool()> stopped_ = [] { return false; };
};

TEST_F(PlanCheckTest, CountsWhatARunWouldMake) {
  const auto check = Check("leader\na.csv\nb.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->items, 4);
  EXPECT_EQ(check->leaders, 2);
  EXPECT_EQ(check->files, 2);
  EXPECT_EQ(check->bad_line_count, 0);
  EXPECT_THAT(BadLinesError(*check), IsOk());
}

TEST_F(PlanCheckTest, EveryBadLineIsNamedWithAllItsFields) {
  const auto check = Check(
      "leader\tlabels\tseed\tleader_side\n"
      "a.csv\twaltz=1\t\t\n"
      "b.csv\tkick\t-1\tup\n"
      "b.csv\tkick=1\n"
      "a.csv\tkick=1\t7\tleft\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->bad_line_count, 3);
  EXPECT_THAT(
      check->bad_lines,
      ElementsAre("m:2: labels: expected classes of fake@3 (kick, hug), got \"waltz\"",
                  AllOf(StartsWith("m:3: labels: expected CLASS=WEIGHT"),
                        HasSubstr("; leader_side: expected left or right, got \"up\"; seed: ")),
                  "m:4: columns: expected 4 as the first line names, got 2"));
  EXPECT_EQ(check->items, 1);
  EXPECT_THAT(BadLinesError(*check),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("3 bad lines; no call was made:\n  m:2: labels"),
                             HasSubstr("\n  m:4: columns"))));
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

TEST_F(PlanCheckTest, OnlyItemsOfThePartAreVisitedAndAllLinesChecked) {
  std::vector<int64_t> visited;
  visit_ = [&visited](const Item& item) {
    visited.push_back(item.number);
    return absl::OkStatus();
  };
  PlanPart part;
  part.limit = 2;
  const auto check = Check("leader\tseed\na.csv\t1\nb.csv\t2\nc.csv\tx\n", part);
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->items, 2);
  EXPECT_EQ(check->bad_line_count, 1);
  EXPECT_THAT(visited, ElementsAre(0, 1));
}

// A bad line shifts the numbers of the items after it, so they cannot be compared with a journal.
TEST_F(PlanCheckTest, ItemsAfterABadLineAreNotVisited) {
  std::vector<int64_t> visited;
  visit_ = [&visited](const Item& item) {
    visited.push_back(item.number);
    return absl::OkStatus();
  };
  const auto check = Check("leader\tseed\na.csv\t1\nb.csv\tx\nnone.csv\t2\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_THAT(visited, ElementsAre(0, 1));
  EXPECT_EQ(check->bad_line_count, 1);
}

TEST_F(PlanCheckTest, ErrorOfAVisitEndsTheCheck) {
  visit_ = [](const Item&) { return absl::FailedPreconditionError("changed"); };
  EXPECT_THAT(Check("leader\na.csv\n"), StatusIs(absl::StatusCode::kFailedPrecondition, "changed"));
}

TEST_F(PlanCheckTest, StoppedCheckEnds) {
  stopped_ = [] { return true; };
  const auto check = Check("leader\na.csv\n");
  ASSERT_THAT(check, IsOk());
  EXPECT_EQ(check->items, 0);
}

}  // namespace
}  // namespace duet::client::batch
