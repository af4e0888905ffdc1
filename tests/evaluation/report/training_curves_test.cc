#include "model/evaluation/report/training_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/status_matchers.h"

namespace duet::evaluation::report {
namespace {

using test::IsOk;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::NanSensitiveDoubleEq;
using testing::Not;

LoggedRun Logged(const std::string& name, const std::string& rows) {
  const auto log = experiments::ParseTrainingLog(
      "epoch,generator,reconstruction,bone,continuity,validation_afd,seconds\n" + rows, name);
  EXPECT_THAT(log, IsOk());
  return {name, *log};
}

LoggedRun Validated(const std::string& name) {
  return Logged(name,
                "1,6,5,2,0,0.9,1.5\n2,5,4,1.5,0,0.5,1.5\n3,4,3,1,0,,1.5\n4,3,2,0.5,0,0.6,1.5\n");
}

std::vector<std::string> FigureNames(const ResultSection& section) {
  std::vector<std::string> names;
  for (const ResultFigure& figure : section.figures) names.push_back(figure.name);
  return names;
}

TEST(TrainingCurvesTest, OneRunHasItsLossesInOneFigure) {
  const ResultSection section = DrawTrainingCurves({Validated("s01")}, "60_curves");
  EXPECT_EQ(section.id, "60_curves");
  EXPECT_THAT(FigureNames(section), ElementsAre("60_curves_losses", "60_curves_validation_afd"));
  const std::string& losses = section.figures[0].svg;
  EXPECT_THAT(losses, HasSubstr(">Losses of s01<"));
  EXPECT_THAT(losses, HasSubstr(">bone lengths<"));
  EXPECT_THAT(losses, Not(HasSubstr(">continuity<"))) << "switched off: zero throughout";
  EXPECT_THAT(losses, Not(HasSubstr(">adversarial<"))) << "no such column";
}

TEST(TrainingCurvesTest, ValidationIsDrawnThroughEpochsWithoutAndMarksTheLeast) {
  const std::string svg = DrawTrainingCurves({Validated("s01")}, "c").figures.at(1).svg;
  // Epochs 1, 2 and 4 on a box from 78 to 582: one line of three points, the mark at epoch 2.
  EXPECT_THAT(svg, testing::ContainsRegex("M78 [0-9.]+L246 [0-9.]+L582 "));
  EXPECT_THAT(svg, HasSubstr("M246 48L246 456\" fill=\"none\" stroke=\"#888888\""));
}

TEST(TrainingCurvesTest, SeveralRunsHaveAFigureForEachLoss) {
  const ResultSection section =
      DrawTrainingCurves({Validated("s01"), Logged("s02", "1,6,5,0,0,,2\n2,5,4,0,0,,2\n")}, "c");
  EXPECT_THAT(FigureNames(section),
              ElementsAre("c_generator", "c_reconstruction", "c_bone", "c_validation_afd"));
  EXPECT_THAT(section.figures[1].svg, HasSubstr(">s01<"));
  EXPECT_THAT(section.figures[1].svg, HasSubstr(">s02<"));
  EXPECT_THAT(section.figures[2].svg, Not(HasSubstr(">s02<"))) << "its bone loss was off";
  EXPECT_THAT(section.figures[3].svg, Not(HasSubstr(">s02<"))) << "it held nothing back";
}

TEST(TrainingCurvesTest, TablesTellWhatRunsTookAndReached) {
  const ResultSection section =
      DrawTrainingCurves({Validated("s01"), Logged("s02", "1,6,5,0,0,,2\n2,5,4,0,0,,2\n")}, "c");
  ASSERT_EQ(section.tables.size(), 2u);
  const auto missing = NanSensitiveDoubleEq(std::nan(""));
  EXPECT_EQ(section.tables[0].rows[0].name, "s01");
  EXPECT_THAT(section.tables[0].rows[0].values, ElementsAre(4, 6, 2));
  EXPECT_THAT(section.tables[0].rows[1].values, ElementsAre(2, 4, missing));
  EXPECT_THAT(section.tables[1].rows[0].values, ElementsAre(2, 0.5, 0.5));
  EXPECT_THAT(section.tables[1].rows[1].values, ElementsAre(4, 0, missing));
}

}  // namespace
}  // namespace duet::evaluation::report
