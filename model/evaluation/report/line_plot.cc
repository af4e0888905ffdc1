#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/evaluation/report/plot.h"
#include "model/evaluation/report/plot_frame.h"
#include "model/evaluation/report/ticks.h"

namespace duet::evaluation::report {
namespace {

constexpr double kLabelSize = 13;
constexpr double kBelow = 44, kBeside = 54;  // from the box to the axes' labels
constexpr char kAxisStyle[] = "fill=\"none\" stroke=\"#222222\" stroke-width=\"1\"";
constexpr char kGridStyle[] = "fill=\"none\" stroke=\"#dddddd\" stroke-width=\"0.8\"";
constexpr char kMarkStyle[] =
    "fill=\"none\" stroke=\"#888888\" stroke-width=\"1\" stroke-dasharray=\"2 3\"";
constexpr int kTickCount = 6;
constexpr double kRoom = 0.04;  // above and below the points
constexpr double kLegendHalfLine = 14;

// Where the values of a plot stand on its y axis; not finite: a gap.
metrics::Point2 OnAxis(const LinePlot& plot, metrics::Point2 point) {
  if (plot.log_y) point[1] = point[1] > 0 ? std::log10(point[1]) : std::nan("");
  return std::isfinite(point[0]) ? point : metrics::Point2{point[0], std::nan("")};
}

Frame FrameOf(const LinePlot& plot) {
  Range x, y;
  for (const PlotSeries& series : plot.series) {
    for (const metrics::Point2& point : series.points) {
      const metrics::Point2 at = OnAxis(plot, point);
      if (!std::isfinite(at[1])) continue;
      x.Add(at[0]);
      y.Add(at[1]);
    }
  }
  y = y.Usable().Widened(kRoom);
  if (plot.y_range) {
    const metrics::Point2 low = OnAxis(plot, {0, plot.y_range->first});
    const metrics::Point2 high = OnAxis(plot, {0, plot.y_range->second});
    y = Range{low[1], high[1]}.Usable();
  }
  return {BoxWithAxes(), x.Usable(), y};
}

std::vector<double> YTicks(const LinePlot& plot, const Range& y) {
  if (!plot.log_y) return RoundTicks(y.low, y.high, kTickCount);
  return LogTicks(std::pow(10, y.low), std::pow(10, y.high), kTickCount);
}

void DrawAxes(const LinePlot& plot, const Frame& frame, SvgWriter* svg) {
  const Box& box = frame.box();
  for (const double x : RoundTicks(frame.x().low, frame.x().high, kTickCount)) {
    svg->Line(frame.X(x), box.top, frame.X(x), box.floor, kGridStyle);
    svg->Text(frame.X(x), box.floor + 18, TickText(x), TextAnchor::kMiddle, kTickSize);
  }
  for (const double tick : YTicks(plot, frame.y())) {
    const double y = frame.Y(OnAxis(plot, {0, tick})[1]);
    svg->Line(box.left, y, box.right, y, kGridStyle);
    svg->Text(box.left - 8, y + 4, TickText(tick), TextAnchor::kEnd, kTickSize);
  }
  for (const double x : plot.marked_x) {
    if (x < frame.x().low || x > frame.x().high) continue;
    svg->Line(frame.X(x), box.top, frame.X(x), box.floor, kMarkStyle);
  }
  svg->Path('M' + SvgNumber(box.left) + ' ' + SvgNumber(box.top) + 'V' + SvgNumber(box.floor) +
                'H' + SvgNumber(box.right),
            kAxisStyle);
  svg->Text((box.left + box.right) / 2, box.floor + kBelow, plot.x_label, TextAnchor::kMiddle,
            kLabelSize);
  svg->TextUpwards(box.left - kBeside, (box.top + box.floor) / 2, plot.y_label, kLabelSize);
}

// The content of a d attribute; empty without a point.
std::string PathOf(const LinePlot& plot, const Frame& frame,
                   const std::vector<metrics::Point2>& points) {
  std::string path;
  bool pen_down = false;
  for (const metrics::Point2& point : points) {
    metrics::Point2 at = OnAxis(plot, point);
    if (!std::isfinite(at[1])) {
      pen_down = false;
      continue;
    }
    // What leaves a given range runs along its edge.
    at[1] = std::clamp(at[1], frame.y().low, frame.y().high);
    path += (pen_down ? 'L' : 'M') + SvgNumber(frame.X(at[0])) + ' ' + SvgNumber(frame.Y(at[1]));
    pen_down = true;
  }
  return path;
}

// Each point's mean with those up to half a window away; gaps stay.
std::vector<metrics::Point2> RunningMean(const std::vector<metrics::Point2>& points, int window) {
  std::vector<metrics::Point2> smooth = points;
  const size_t reach = static_cast<size_t>(window) / 2;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i][1])) continue;
    double sum = 0, count = 0;
    for (size_t k = i - std::min(reach, i); k <= std::min(i + reach, points.size() - 1); ++k) {
      if (!std::isfinite(points[k][1])) continue;
      sum += points[k][1];
      ++count;
    }
    smooth[i][1] = sum / count;
  }
  return smooth;
}

void DrawMarkers(const LinePlot& plot, const Frame& frame, size_t index, SvgWriter* svg) {
  for (const metrics::Point2& point : plot.series[index].points) {
    const metrics::Point2 at = OnAxis(plot, point);
    if (!std::isfinite(at[1])) continue;
    const double y = std::clamp(at[1], frame.y().low, frame.y().high);
    svg->Marker(index, frame.X(at[0]), frame.Y(y), kPointRadius * 0.8);
  }
}

void DrawLine(const LinePlot& plot, const Frame& frame, size_t index, SvgWriter* svg) {
  const PlotSeries& series = plot.series[index];
  const std::string colour = "fill=\"none\" stroke-linejoin=\"round\" stroke=\"" +
                             SeriesColour(index) + "\" stroke-width=\"";
  const std::string style = colour + "1.8\" stroke-dasharray=\"" + SeriesDash(index) + '"';
  const bool is_smooth = plot.running_mean > 1;
  const std::string path = PathOf(plot, frame, series.points);
  if (is_smooth && !path.empty()) svg->Path(path, colour + "1\" stroke-opacity=\"0.3\"");
  const std::string line =
      is_smooth ? PathOf(plot, frame, RunningMean(series.points, plot.running_mean)) : path;
  if (!line.empty()) svg->Path(line, style);
  const LegendPlace sample = LegendSample(frame.box(), index);
  svg->Line(sample.x - kLegendHalfLine, sample.y, sample.x + kLegendHalfLine, sample.y, style);
  if (plot.markers) {
    DrawMarkers(plot, frame, index, svg);
    svg->Marker(index, sample.x, sample.y, kPointRadius * 0.8);
  }
  DrawLegendText(frame.box(), index, series.name, svg);
}

}  // namespace

std::string ToSvg(const LinePlot& plot) {
  const Frame frame = FrameOf(plot);
  SvgWriter svg = MakeFigure(frame.box(), plot.title, plot.series);
  DrawAxes(plot, frame, &svg);
  for (size_t i = 0; i < plot.series.size(); ++i) DrawLine(plot, frame, i, &svg);
  return svg.Finish();
}

}  // namespace duet::evaluation::report
