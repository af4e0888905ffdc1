#ifndef DUET_MODEL_EVALUATION_REPORT_PLOT_H_
#define DUET_MODEL_EVALUATION_REPORT_PLOT_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/evaluation/metrics/tsne.h"

// Figures as stand-alone SVG documents, fit to print: vector text, no script, no outside file.
// Series are told apart by colour (Okabe and Ito's palette, which colour-blind readers can tell
// apart) and by marker or dash, so that a figure survives a grey print.

namespace duet::evaluation::report {

struct PlotSeries {
  std::string name;
  std::vector<metrics::Point2> points;  // x, y; a point that is not finite leaves a gap
};

// Points by class, without axes and with one scale: for maps whose distances alone mean something
// (t-SNE).
struct ScatterPlot {
  std::string title;
  std::vector<PlotSeries> series;
};
std::string ToSvg(const ScatterPlot& plot);

// Lines over labelled axes.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  std::optional<std::pair<double, double>> y_range;  // default: what the points need
  bool log_y = false;                                // values that are not positive leave gaps
  bool markers = false;                              // for sweeps with few points
  std::vector<double> marked_x;                      // vertical dotted lines
  // Above 1: lines are means over this many points, with the points themselves faint behind.
  int running_mean = 1;
};
std::string ToSvg(const LinePlot& plot);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_PLOT_H_
