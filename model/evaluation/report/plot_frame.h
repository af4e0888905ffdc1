#ifndef DUET_MODEL_EVALUATION_REPORT_PLOT_FRAME_H_
#define DUET_MODEL_EVALUATION_REPORT_PLOT_FRAME_H_

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model/evaluation/report/plot.h"
#include "model/evaluation/report/svg.h"

// What all kinds of plots share: title, box and legend. Units: pixels.

namespace duet::evaluation::report {

// The least interval that holds what was added.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double value);
  // The same with an extent above 0, which can be divided by: an interval of length 1 where nothing
  // or one value alone was added.
  Range Usable() const;
  Range Widened(double share) const;
  double Extent() const { return high - low; }
};

// The box that data are drawn in.
struct Box {
  double left = 0, right = 0, top = 0, floor = 0;
};

// The box of a plot with axes, and of one that needs no room for their labels.
Box BoxWithAxes();
Box BoxWithoutAxes();

// Maps data to pixels.
class Frame {
 public:
  Frame(const Box& box, Range x, Range y) : box_(box), x_(x), y_(y) {}

  double X(double value) const;
  double Y(double value) const;
  const Box& box() const { return box_; }
  const Range& x() const { return x_; }
  const Range& y() const { return y_; }

 private:
  Box box_;
  Range x_, y_;
};

// An empty figure with a title, and room for a legend of the series: long ones make it larger.
SvgWriter MakeFigure(const Box& box, const std::string& title,
                     const std::vector<PlotSeries>& series);

inline constexpr double kTickSize = 12;
inline constexpr double kPointRadius = 4.5;

// Where the legend's sample of a series stands: its middle is `x`.
struct LegendPlace {
  double x = 0, y = 0;
};
LegendPlace LegendSample(const Box& box, size_t index);
void DrawLegendText(const Box& box, size_t index, const std::string& name, SvgWriter* svg);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_PLOT_FRAME_H_
