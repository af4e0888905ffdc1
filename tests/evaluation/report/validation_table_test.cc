#include "model/evaluation/report/validation_table.h"

#include <gmock/gmock.h>

#include <cmath>

namespace duet::evaluation::report {
namespace {

using ::testing::ElementsAre;

LoggedRun Logged(const std::string& name, std::vector<double> errors) {
  LoggedRun run{name, {}};
  for (size_t i = 0; i < errors.size(); ++i) run.log.epochs.push_back(static_cast<double>(i + 1));
  run.log.columns["validation_afd"] = std::move(errors);
  return run;
}

TEST(ValidationTableTest, ShowsTheLastEpochOfEveryRunAndTheirMean) {
  const Table table = ValidationTable("t", "validation_afd",
                                      {{"plain", {Logged("s01", {3, 2}), Logged("s02", {9, 4})}},
                                       {"other", {Logged("s01", {1, 5}), Logged("s02", {1, 7})}}});
  EXPECT_THAT(table.columns, ElementsAre("s01", "s02", "mean"));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].name, "plain");
  EXPECT_THAT(table.rows[0].values, ElementsAre(2, 4, 3));
  EXPECT_THAT(table.rows[1].values, ElementsAre(5, 7, 6));
  EXPECT_EQ(table.best, Best::kLowest);
}

TEST(ValidationTableTest, MissingRunsAndColumnsAreNoFigures) {
  const Table table = ValidationTable(
      "t", "validation_afd",
      {{"plain", {Logged("s01", {3}), Logged("s02", {4})}}, {"less", {Logged("s01", {1})}}});
  EXPECT_TRUE(std::isnan(table.rows[1].values[1]));
  EXPECT_TRUE(std::isnan(table.rows[1].values[2]));
  const Table none = ValidationTable("t", "validation_afd_pose", {{"plain", {Logged("s01", {3})}}});
  EXPECT_TRUE(std::isnan(none.rows[0].values[0]));
}

}  // namespace
}  // namespace duet::evaluation::report
