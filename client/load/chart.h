#ifndef DUET_CLIENT_LOAD_CHART_H_
#define DUET_CLIENT_LOAD_CHART_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/string_view.h"

// Lines over labelled axes as an <svg> element, to stand in a page that has ChartStyle() among its
// styles. Series are told apart by colour (Okabe and Ito's palette, which colour-blind readers can
// tell apart) and by dash.

namespace duet::client::load {

struct ChartSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  // x ascending
};

struct ChartTick {
  double value = 0;
  std::string label;
};

struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<ChartSeries> series;
  bool log_x = false;              // values must then be above 0; others are left out
  bool log_y = false;              // the same; otherwise the axis begins at 0
  std::vector<ChartTick> x_ticks;  // empty: at round values
};

std::string ToSvg(const Chart& chart);
std::string ChartStyle();

// Text for the content of an element or for an attribute in double quotes.
std::string EscapeMarkup(absl::string_view text);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_CHART_H_
