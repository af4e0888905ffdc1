#include "client/load/chart.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "model/base/text.h"

namespace duet::client::load {
namespace {

// Units: pixels, y down.
constexpr double kWidth = 640, kHeight = 340;
constexpr double kLeft = 66, kRight = 16, kTop = 62, kBottom = 46;
constexpr double kGlyph = 6.6;  // width of a character of the legend, at most
constexpr double kLegendLine = 26;
constexpr std::size_t kStyles = 8;

std::string Number(double value) {
  std::string text;
  base::AppendFixed(&text, value, 1);
  return text;
}

std::string Label(double value) {
  std::string text;
  base::AppendNumber(&text, std::abs(value) < 1e-12 ? 0.0 : value);
  return text;
}

// One direction of a chart: from values to a part of its length.
class Axis {
 public:
  Axis(bool log, double low, double high) : log_(log) {
    low_ = Scaled(low);
    high_ = Scaled(high);
    if (high_ - low_ < 1e-9) {
      low_ -= log ? 0.3 : 0.5;
      high_ += log ? 0.3 : 0.5;
    }
  }

  bool Has(double value) const { return std::isfinite(value) && (!log_ || value > 0); }
  double Part(double value) const { return (Scaled(value) - low_) / (high_ - low_); }

  std::vector<ChartTick> RoundTicks() const { return log_ ? LogTicks() : LinearTicks(); }

 private:
  double Scaled(double value) const { return log_ ? std::log10(value) : value; }

  std::vector<ChartTick> LinearTicks() const {
    const double rough = (high_ - low_) / 5;
    const double decade = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * decade;
    for (const double nice : {5.0, 2.0, 1.0}) {
      if (nice * decade >= rough) step = nice * decade;
    }
    std::vector<ChartTick> ticks;
    for (double i = std::ceil(low_ / step - 1e-9); i * step <= high_ + 1e-9 * step; ++i) {
      const double value = std::round(i * step / step * 1e9) / 1e9 * step;
      ticks.push_back({value, Label(std::stod(absl::StrFormat("%.10g", value)))});
    }
    return ticks;
  }

  // The decades; 1, 2 and 5 of each where few decades are shown, and all nine where less than one.
  std::vector<ChartTick> LogTicks() const {
    const double decades = high_ - low_;
    std::vector<double> digits = {1};
    if (decades < 2.5) digits = {1, 2, 5};
    if (decades < 0.7) digits = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    std::vector<ChartTick> ticks;
    for (double decade = std::floor(low_); decade <= high_; ++decade) {
      for (const double digit : digits) {
        const double value = digit * std::pow(10, decade);
        const double at = std::log10(value);
        if (at < low_ - 1e-9 || at > high_ + 1e-9) continue;
        ticks.push_back({value, Label(std::stod(absl::StrFormat("%.10g", value)))});
      }
    }
    return ticks;
  }

  const bool log_;
  double low_ = 0;
  double high_ = 1;
};

struct Range {
  double low = 0;
  double high = 0;
  bool is_empty = true;

  void Add(double value) {
    low = is_empty ? value : std::min(low, value);
    high = is_empty ? value : std::max(high, value);
    is_empty = false;
  }
};

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart), x_(MakeX(chart)), y_(MakeY(chart)) {}

  std::string Svg() {
    absl::StrAppendFormat(&svg_, "<svg viewBox=\"0 0 %g %g\" role=\"img\" aria-label=\"%s\">\n",
                          kWidth, kHeight, EscapeMarkup(chart_.title));
    Text(kLeft, 20, "start", "title", chart_.title);
    DrawLegend();
    DrawAxes();
    for (std::size_t i = 0; i < chart_.series.size(); ++i) DrawSeries(i);
    return svg_ + "</svg>\n";
  }

 private:
  static Axis MakeX(const Chart& chart) {
    Range range;
    for (const ChartSeries& series : chart.series) {
      for (const auto& [x, y] : series.points) {
        if (std::isfinite(x) && (!chart.log_x || x > 0)) range.Add(x);
      }
    }
    if (range.is_empty) return {chart.log_x, 1, 10};
    return {chart.log_x, range.low, range.high};
  }
  static Axis MakeY(const Chart& chart) {
    Range range;
    for (const ChartSeries& series : chart.series) {
      for (const auto& [x, y] : series.points) {
        if (std::isfinite(y) && (!chart.log_y || y > 0)) range.Add(y);
      }
    }
    if (range.is_empty) return {chart.log_y, 1, 10};
    if (chart.log_y) return {true, range.low / 1.15, range.high * 1.15};
    return {false, 0, range.high > 0 ? 1.06 * range.high : 1};
  }

  double X(double value) const { return kLeft + x_.Part(value) * (kWidth - kLeft - kRight); }
  double Y(double value) const {
    return kHeight - kBottom - y_.Part(value) * (kHeight - kTop - kBottom);
  }

  void Text(double x, double y, const char* anchor, const char* style, absl::string_view text,
            absl::string_view more = "") {
    absl::StrAppend(&svg_, "<text x=\"", Number(x), "\" y=\"", Number(y), "\" text-anchor=\"",
                    anchor, "\" class=\"", style, "\"", more, ">", EscapeMarkup(text), "</text>\n");
  }
  void Line(double x0, double y0, double x1, double y1, absl::string_view style) {
    absl::StrAppend(&svg_, "<path d=\"M", Number(x0), " ", Number(y0), "L", Number(x1), " ",
                    Number(y1), "\" class=\"", style, "\"/>\n");
  }

  static std::string Style(std::size_t series) { return absl::StrCat("s", series % kStyles); }

  void DrawLegend() {
    double x = kLeft;
    for (std::size_t i = 0; i < chart_.series.size(); ++i) {
      const std::string& name = chart_.series[i].name;
      const double width = kLegendLine + 6 + kGlyph * static_cast<double>(name.size()) + 14;
      if (x + width > kWidth && i > 0) {
        Text(x, 42, "start", "tick", "...");
        return;
      }
      Line(x, 38, x + kLegendLine, 38, Style(i));
      Text(x + kLegendLine + 6, 42, "start", "tick", name);
      x += width;
    }
  }

  void DrawAxes() {
    const double floor = kHeight - kBottom;
    for (const ChartTick& tick : y_.RoundTicks()) {
      Line(kLeft, Y(tick.value), kWidth - kRight, Y(tick.value), "grid");
      Text(kLeft - 7, Y(tick.value) + 4, "end", "tick", tick.label);
    }
    for (const ChartTick& tick : chart_.x_ticks.empty() ? x_.RoundTicks() : chart_.x_ticks) {
      Line(X(tick.value), floor, X(tick.value), floor + 5, "axis");
      Text(X(tick.value), floor + 18, "middle", "tick", tick.label);
    }
    Line(kLeft, floor, kWidth - kRight, floor, "axis");
    Text((kLeft + kWidth - kRight) / 2, kHeight - 8, "middle", "label", chart_.x_label);
    const double middle = (kTop + floor) / 2;
    Text(14, middle, "middle", "label", chart_.y_label,
         absl::StrCat(" transform=\"rotate(-90 14 ", Number(middle), ")\""));
  }

  void DrawSeries(std::size_t index) {
    std::string path, dots;
    const auto& points = chart_.series[index].points;
    bool pen_down = false;
    for (const auto& [x, y] : points) {
      const bool shown = x_.Has(x) && y_.Has(y);
      if (shown) {
        absl::StrAppend(&path, pen_down ? "L" : "M", Number(X(x)), " ", Number(Y(y)));
        absl::StrAppend(&dots, "<circle cx=\"", Number(X(x)), "\" cy=\"", Number(Y(y)),
                        "\" r=\"2.6\" class=\"dot ", Style(index), "\"/>\n");
      }
      pen_down = shown;
    }
    absl::StrAppend(&svg_, "<path d=\"", path, "\" class=\"", Style(index), "\"/>\n");
    constexpr std::size_t kMostDots = 24;  // of a line of more points they would hide it
    if (points.size() <= kMostDots) svg_ += dots;
  }

  const Chart& chart_;
  const Axis x_, y_;
  std::string svg_;
};

}  // namespace

std::string ToSvg(const Chart& chart) { return Drawing(chart).Svg(); }

std::string ChartStyle() {
  constexpr const char* kColours[kStyles] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#8c6bb1", "#7f7f7f"};
  constexpr const char* kDashes[kStyles] = {"none", "7 3",     "2 3",     "7 3 2 3",
                                            "12 4", "4 2 1 2", "1 2 5 2", "4 5"};
  std::string css =
      "svg{width:100%;height:auto}svg path{fill:none}svg text{fill:currentColor;"
      "font-family:inherit}.title{font-size:15px;font-weight:600}.label{font-size:12.5px}"
      ".tick{font-size:11.5px}.axis{stroke:currentColor;stroke-width:1}"
      ".grid{stroke:currentColor;stroke-opacity:.14;stroke-width:1}\n";
  for (std::size_t i = 0; i < kStyles; ++i) {
    absl::StrAppend(&css, "path.s", i, "{stroke:", kColours[i],
                    ";stroke-width:2;stroke-dasharray:", kDashes[i], "}.dot.s", i,
                    "{fill:", kColours[i], "}\n");
  }
  return css;
}

std::string EscapeMarkup(absl::string_view text) {
  return absl::StrReplaceAll(text,
                             {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

}  // namespace duet::client::load
