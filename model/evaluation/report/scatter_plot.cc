#include <cmath>
#include <cstddef>

#include "model/evaluation/report/plot.h"
#include "model/evaluation/report/plot_frame.h"

namespace duet::evaluation::report {
namespace {

constexpr char kBoxStyle[] = "fill=\"none\" stroke=\"#222222\" stroke-width=\"1\"";
constexpr double kRoom = 0.05;  // on either side of the points

bool IsDrawn(const metrics::Point2& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]);
}

// One scale for both directions: distances are all that a map of points shows.
Frame FrameOf(const ScatterPlot& plot) {
  Range x, y;
  for (const PlotSeries& series : plot.series) {
    for (const metrics::Point2& point : series.points) {
      if (!IsDrawn(point)) continue;
      x.Add(point[0]);
      y.Add(point[1]);
    }
  }
  x = x.Usable().Widened(kRoom);
  y = y.Usable().Widened(kRoom);
  const Box box = BoxWithoutAxes();
  const double wanted = (box.right - box.left) / (box.floor - box.top);
  const double ratio = x.Extent() / y.Extent();
  if (ratio < wanted) x = x.Widened((wanted / ratio - 1) / 2);
  if (ratio > wanted) y = y.Widened((ratio / wanted - 1) / 2);
  return {box, x, y};
}

}  // namespace

std::string ToSvg(const ScatterPlot& plot) {
  const Frame frame = FrameOf(plot);
  const Box& box = frame.box();
  SvgWriter svg = MakeFigure(box, plot.title, plot.series);
  svg.Path('M' + SvgNumber(box.left) + ' ' + SvgNumber(box.top) + 'H' + SvgNumber(box.right) + 'V' +
               SvgNumber(box.floor) + 'H' + SvgNumber(box.left) + 'Z',
           kBoxStyle);
  for (size_t i = 0; i < plot.series.size(); ++i) {
    for (const metrics::Point2& point : plot.series[i].points) {
      if (IsDrawn(point)) svg.Marker(i, frame.X(point[0]), frame.Y(point[1]), kPointRadius);
    }
    const LegendPlace sample = LegendSample(box, i);
    svg.Marker(i, sample.x, sample.y, kPointRadius);
    DrawLegendText(box, i, plot.series[i].name, &svg);
  }
  return svg.Finish();
}

}  // namespace duet::evaluation::report
