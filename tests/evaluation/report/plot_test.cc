#include "model/evaluation/report/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/evaluation/report/svg.h"

namespace duet::evaluation::report {
namespace {

using testing::HasSubstr;
using testing::Not;

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(SvgTest, NumbersAreValid) {
  EXPECT_EQ(SvgNumber(1.5), "1.5");
  EXPECT_EQ(SvgNumber(-0.001), "0");
  EXPECT_EQ(SvgNumber(1e7), "10000000");
}

TEST(SvgTest, SeriesDifferInColourAndDash) {
  for (size_t i = 0; i < 8; ++i) {
    for (size_t j = 0; j < i; ++j) {
      EXPECT_NE(SeriesColour(i), SeriesColour(j));
      EXPECT_NE(SeriesDash(i), SeriesDash(j));
    }
  }
}

TEST(ScatterPlotTest, DrawsEveryFinitePointAndALegend) {
  ScatterPlot plot;
  plot.title = "Latent space <test>";
  plot.series = {{"kick", {{0, 0}, {1, 1}, {std::nan(""), 1}}}, {"punch & co", {{0, 1}}}};
  const std::string svg = ToSvg(plot);
  // Two finite points and the legend's one.
  EXPECT_EQ(Count(svg, "<circle"), 3);
  EXPECT_THAT(svg, HasSubstr("Latent space &lt;test&gt;"));
  EXPECT_THAT(svg, HasSubstr("punch &amp; co"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(svg.rfind("</svg>\n"), svg.size() - 7);
}

// A map's distances mean something: they must not be stretched.
TEST(ScatterPlotTest, HasOneScale) {
  ScatterPlot plot;
  plot.series = {{"wide", {{0, 0}, {10, 0}, {0, 1}}}};
  const std::string svg = ToSvg(plot);
  // 10 wide, with a twentieth on either side, over 562 pixels: 51.09 each.
  EXPECT_THAT(svg, HasSubstr("cx=\"45.55\" cy=\"299.55\""));
  EXPECT_THAT(svg, HasSubstr("cx=\"556.45\" cy=\"299.55\""));
  EXPECT_THAT(svg, HasSubstr("cx=\"45.55\" cy=\"248.45\""));
}

TEST(LinePlotTest, PlacesPointsOnTheAxes) {
  LinePlot plot;
  plot.x_label = "weight";
  plot.y_label = "probability";
  plot.y_range = {0, 1};
  plot.series = {{"kick", {{-1, 0}, {0, 0.5}, {2, 1}}}};
  const std::string svg = ToSvg(plot);
  // The corners of the axes' box: x 78 to 582, y 456 up to 48.
  EXPECT_THAT(svg, HasSubstr("M78 456L246 252L582 48"));
  EXPECT_THAT(svg, HasSubstr(">weight<"));
  EXPECT_THAT(svg, HasSubstr(">probability<"));
  EXPECT_THAT(svg, HasSubstr(">-1<"));
  EXPECT_THAT(svg, HasSubstr(">0.5<"));
}

TEST(LinePlotTest, BreaksAtGapsAndHoldsToTheRange) {
  LinePlot plot;
  plot.y_range = {0, 1};
  plot.series = {{"a", {{0, 0}, {1, 0}, {2, std::nan("")}, {3, 9}, {4, 9}}}};
  const std::string svg = ToSvg(plot);
  EXPECT_THAT(svg, HasSubstr("M78 456L204 456M456 48L582 48"));
}

TEST(LinePlotTest, LogarithmicAxisSkipsWhatIsNotPositive) {
  LinePlot plot;
  plot.log_y = true;
  plot.y_range = {0.01, 100};
  plot.series = {{"loss", {{0, 100}, {1, 0}, {2, 1}, {3, 0.01}}}};
  const std::string svg = ToSvg(plot);
  EXPECT_THAT(svg, HasSubstr("M78 48M414 252L582 456"));
  EXPECT_THAT(svg, HasSubstr(">0.01<"));
  EXPECT_THAT(svg, HasSubstr(">100<"));
}

TEST(LinePlotTest, ShortLogarithmicAxisHasRoundTicks) {
  LinePlot plot;
  plot.log_y = true;
  plot.y_range = {1.5, 4.5};
  plot.series = {{"loss", {{0, 4}, {1, 2}}}};
  const std::string svg = ToSvg(plot);
  EXPECT_THAT(svg, HasSubstr(">2.5<"));
  // 3 stands half way from 2 to 4.5 in logarithms: 48 + 408 * log(4.5 / 3) / log(4.5 / 1.5).
  EXPECT_THAT(svg, HasSubstr("M78 198.58L582 198.58"));
}

TEST(LinePlotTest, MakesRoomForItsLegendAndTitle) {
  LinePlot plot;
  plot.series = {{"short", {{0, 0}, {1, 1}}}};
  EXPECT_THAT(ToSvg(plot), HasSubstr("viewBox=\"0 0 760 520\""));
  plot.series[0].name = std::string(40, 'w');
  // 582 to the box's edge, 46 to the text, 40 characters of at most 7.44, 20 of margin.
  EXPECT_THAT(ToSvg(plot), HasSubstr("viewBox=\"0 0 945.6 520\""));
  plot.series.assign(30, {"one of many", {{0, 0}}});
  EXPECT_THAT(ToSvg(plot), HasSubstr("viewBox=\"0 0 760 728\""));
  plot.title = std::string(133, 'w');  // twice what fits
  EXPECT_THAT(ToSvg(plot), HasSubstr("font-size=\"7.97\""));
}

TEST(LinePlotTest, EmptyAndConstantSeriesAreDrawn) {
  LinePlot plot;
  EXPECT_THAT(ToSvg(plot), HasSubstr("</svg>"));
  plot.series = {{"none", {}}, {"flat", {{1, 3}, {1, 3}}}};
  EXPECT_THAT(ToSvg(plot), Not(HasSubstr("nan")));
  EXPECT_THAT(ToSvg(plot), Not(HasSubstr("inf")));
}

TEST(LinePlotTest, RunningMeansRunBeforeFaintPoints) {
  LinePlot plot;
  plot.y_range = {0, 8};
  plot.running_mean = 3;
  plot.series = {{"a", {{0, 8}, {1, 0}, {2, 4}, {3, std::nan("")}, {4, 2}}}};
  const std::string svg = ToSvg(plot);
  // Values 0 to 8 stand at y 456 to 48. Means of (8 0), (8 0 4), (0 4) and 2 alone.
  EXPECT_THAT(svg, HasSubstr("M78 48L204 456L330 252M582 354\" fill=\"none\""));
  EXPECT_THAT(svg, HasSubstr("M78 252L204 252L330 354M582 354\" fill=\"none\""));
  EXPECT_LT(svg.find("stroke-opacity=\"0.3\""), svg.find("M78 252L204"));
}

TEST(LinePlotTest, MarksTheGivenPlaces) {
  LinePlot plot;
  plot.series = {{"a", {{0, 0}, {10, 1}}}};
  const int before = Count(ToSvg(plot), "#888888");
  plot.marked_x = {5, 50};
  EXPECT_EQ(Count(ToSvg(plot), "#888888"), before + 1);
}

}  // namespace
}  // namespace duet::evaluation::report
