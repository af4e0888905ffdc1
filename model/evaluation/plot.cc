#include "model/evaluation/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "model/evaluation/svg.h"
#include "model/evaluation/ticks.h"

namespace duet {
namespace {

// The least size of a figure, and where its box stands; long legends make it larger.
constexpr double kWidth = 760, kHeight = 520;
constexpr double kTop = 48, kBottom = 64, kLeft = 78, kLegend = 178, kMargin = 20;
constexpr double kLegendText = 46;  // from the box's right edge
constexpr double kTitleSize = 16, kLabelSize = 13, kTickSize = 12;
constexpr double kPointRadius = 4.5, kLegendStep = 22;
constexpr char kAxisStyle[] = "fill=\"none\" stroke=\"#222222\" stroke-width=\"1\"";
constexpr char kGridStyle[] = "fill=\"none\" stroke=\"#dddddd\" stroke-width=\"0.8\"";
constexpr char kMarkStyle[] =
    "fill=\"none\" stroke=\"#888888\" stroke-width=\"1\" stroke-dasharray=\"2 3\"";
constexpr int kTickCount = 6;
// Width of a character in units of the font's size, at most, over the fonts that may be used.
constexpr double kGlyphWidth = 0.62;

bool IsDrawn(const Point2& point) { return std::isfinite(point[0]) && std::isfinite(point[1]); }

// The least interval that holds what was added.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // Never empty and never without extent, so that it can be divided by.
  Range Usable() const {
    if (low > high) return {0, 1};
    if (low == high) return {low - 0.5, high + 0.5};
    return *this;
  }
  Range Widened(double share) const {
    const double margin = share * (high - low);
    return {low - margin, high + margin};
  }
};

// Maps data to pixels.
class Frame {
 public:
  Frame(Range x, Range y) : x_(x), y_(y) {}

  double X(double value) const {
    return kLeft + (value - x_.low) / (x_.high - x_.low) * (Right() - kLeft);
  }
  double Y(double value) const {
    return Floor() - (value - y_.low) / (y_.high - y_.low) * (Floor() - kTop);
  }
  static double Right() { return kWidth - kLegend; }
  static double Floor() { return kHeight - kBottom; }
  const Range& x() const { return x_; }
  const Range& y() const { return y_; }

 private:
  Range x_, y_;
};

double TextWidth(const std::string& text, double size) {
  return kGlyphWidth * size * static_cast<double>(text.size());
}

// An empty figure that has room for its legend.
SvgWriter MakeFigure(const std::string& title, const std::vector<PlotSeries>& series) {
  double legend = kLegend;
  for (const PlotSeries& one : series) {
    legend = std::max(legend, kLegendText + TextWidth(one.name, kTickSize) + kMargin);
  }
  const double width = kWidth - kLegend + legend;
  const double least_height = kTop + kLegendStep * static_cast<double>(series.size()) + kMargin;
  SvgWriter svg(width, std::max(kHeight, least_height));
  const double room = width - kLeft - kMargin;
  const double size = std::min(kTitleSize, kTitleSize * room / TextWidth(title + " ", kTitleSize));
  svg.Text(kLeft, kTop - 20, title, TextAnchor::kStart, size, "font-weight=\"bold\"");
  return svg;
}

void DrawLegendText(size_t index, const std::string& name, SvgWriter* svg) {
  svg->Text(Frame::Right() + kLegendText, kTop + 12 + kLegendStep * static_cast<double>(index),
            name, TextAnchor::kStart, kTickSize);
}

double LegendY(size_t index) { return kTop + 8 + kLegendStep * static_cast<double>(index); }

// Where the values of a plot stand on its y axis.
Point2 OnAxis(const LinePlot& plot, Point2 point) {
  if (!plot.log_y) return point;
  // The logarithm of what is not positive is not finite: a gap.
  return {point[0], point[1] > 0 ? std::log10(point[1]) : std::nan("")};
}

Frame FrameOf(const LinePlot& plot) {
  Range x, y;
  for (const PlotSeries& series : plot.series) {
    for (const Point2& point : series.points) {
      const Point2 at = OnAxis(plot, point);
      if (!IsDrawn(at)) continue;
      x.Add(at[0]);
      y.Add(at[1]);
    }
  }
  y = y.Usable().Widened(0.04);
  if (plot.y_range) {
    const Point2 low = OnAxis(plot, {0, plot.y_range->first});
    const Point2 high = OnAxis(plot, {0, plot.y_range->second});
    y = Range{low[1], high[1]}.Usable();
  }
  return {x.Usable(), y};
}

std::vector<double> YTicks(const LinePlot& plot, const Range& y) {
  if (!plot.log_y) return RoundTicks(y.low, y.high, kTickCount);
  return LogTicks(std::pow(10, y.low), std::pow(10, y.high), kTickCount);
}

void DrawAxes(const LinePlot& plot, const Frame& frame, SvgWriter* svg) {
  for (const double x : RoundTicks(frame.x().low, frame.x().high, kTickCount)) {
    svg->Line(frame.X(x), kTop, frame.X(x), Frame::Floor(), kGridStyle);
    svg->Text(frame.X(x), Frame::Floor() + 18, TickText(x), TextAnchor::kMiddle, kTickSize);
  }
  for (const double tick : YTicks(plot, frame.y())) {
    const double y = frame.Y(OnAxis(plot, {0, tick})[1]);
    svg->Line(kLeft, y, Frame::Right(), y, kGridStyle);
    svg->Text(kLeft - 8, y + 4, TickText(tick), TextAnchor::kEnd, kTickSize);
  }
  for (const double x : plot.marked_x) {
    if (x < frame.x().low || x > frame.x().high) continue;
    svg->Line(frame.X(x), kTop, frame.X(x), Frame::Floor(), kMarkStyle);
  }
  svg->Path('M' + SvgNumber(kLeft) + ' ' + SvgNumber(kTop) + 'V' + SvgNumber(Frame::Floor()) + 'H' +
                SvgNumber(Frame::Right()),
            kAxisStyle);
  svg->Text((kLeft + Frame::Right()) / 2, kHeight - kMargin, plot.x_label, TextAnchor::kMiddle,
            kLabelSize);
  svg->TextUpwards(kMargin + 4, (kTop + Frame::Floor()) / 2, plot.y_label, kLabelSize);
}

void DrawLine(const LinePlot& plot, const Frame& frame, size_t index, SvgWriter* svg) {
  std::string path;
  bool pen_down = false;
  for (const Point2& point : plot.series[index].points) {
    Point2 at = OnAxis(plot, point);
    if (!IsDrawn(at)) {
      pen_down = false;
      continue;
    }
    // What leaves a given range runs along its edge.
    at[1] = std::clamp(at[1], frame.y().low, frame.y().high);
    path += (pen_down ? 'L' : 'M') + SvgNumber(frame.X(at[0])) + ' ' + SvgNumber(frame.Y(at[1]));
    pen_down = true;
    if (plot.markers) svg->Marker(index, frame.X(at[0]), frame.Y(at[1]), kPointRadius * 0.8);
  }
  const std::string style = "fill=\"none\" stroke=\"" + SeriesColour(index) +
                            "\" stroke-width=\"1.8\" stroke-linejoin=\"round\" "
                            "stroke-dasharray=\"" +
                            SeriesDash(index) + "\"";
  if (!path.empty()) svg->Path(path, style);
  const double x = Frame::Right() + 12, y = LegendY(index);
  svg->Line(x, y, x + 28, y, style);
  if (plot.markers) svg->Marker(index, x + 14, y, kPointRadius * 0.8);
  DrawLegendText(index, plot.series[index].name, svg);
}

}  // namespace

std::string ToSvg(const ScatterPlot& plot) {
  Range x, y;
  for (const PlotSeries& series : plot.series) {
    for (const Point2& point : series.points) {
      if (!IsDrawn(point)) continue;
      x.Add(point[0]);
      y.Add(point[1]);
    }
  }
  const Frame frame(x.Usable().Widened(0.05), y.Usable().Widened(0.05));
  SvgWriter svg = MakeFigure(plot.title, plot.series);
  svg.Path("M" + SvgNumber(kLeft) + ' ' + SvgNumber(kTop) + 'H' + SvgNumber(Frame::Right()) + 'V' +
               SvgNumber(Frame::Floor()) + 'H' + SvgNumber(kLeft) + 'Z',
           kAxisStyle);
  for (size_t i = 0; i < plot.series.size(); ++i) {
    for (const Point2& point : plot.series[i].points) {
      if (IsDrawn(point)) svg.Marker(i, frame.X(point[0]), frame.Y(point[1]), kPointRadius);
    }
    svg.Marker(i, Frame::Right() + 26, LegendY(i), kPointRadius);
    DrawLegendText(i, plot.series[i].name, &svg);
  }
  return svg.Finish();
}

std::string ToSvg(const LinePlot& plot) {
  const Frame frame = FrameOf(plot);
  SvgWriter svg = MakeFigure(plot.title, plot.series);
  DrawAxes(plot, frame, &svg);
  for (size_t i = 0; i < plot.series.size(); ++i) DrawLine(plot, frame, i, &svg);
  return svg.Finish();
}

}  // namespace duet
