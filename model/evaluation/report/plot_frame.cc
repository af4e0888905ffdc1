#include "model/evaluation/report/plot_frame.h"

#include <algorithm>

namespace duet::evaluation::report {
namespace {

constexpr double kWidth = 760, kHeight = 520;  // of a figure, at least
constexpr double kTop = 48, kBottom = 64, kLeft = 78, kLegend = 178, kMargin = 20;
constexpr double kLegendSample = 26, kLegendText = 46;  // from the box's right edge
constexpr double kLegendStep = 22;
constexpr double kTitleSize = 16;
// Width of a character in units of the font's size, at most, over the fonts that may be used.
constexpr double kGlyphWidth = 0.62;

double TextWidth(const std::string& text, double size) {
  return kGlyphWidth * size * static_cast<double>(text.size());
}

}  // namespace

void Range::Add(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

Range Range::Usable() const {
  if (low > high) return {0, 1};
  if (low == high) return {low - 0.5, high + 0.5};
  return *this;
}

Range Range::Widened(double share) const {
  const double margin = share * Extent();
  return {low - margin, high + margin};
}

Box BoxWithAxes() { return {kLeft, kWidth - kLegend, kTop, kHeight - kBottom}; }

Box BoxWithoutAxes() { return {kMargin, kWidth - kLegend, kTop, kHeight - kMargin}; }

double Frame::X(double value) const {
  return box_.left + (value - x_.low) / x_.Extent() * (box_.right - box_.left);
}

double Frame::Y(double value) const {
  return box_.floor - (value - y_.low) / y_.Extent() * (box_.floor - box_.top);
}

SvgWriter MakeFigure(const Box& box, const std::string& title,
                     const std::vector<PlotSeries>& series) {
  double legend = kLegend;
  for (const PlotSeries& one : series) {
    legend = std::max(legend, kLegendText + TextWidth(one.name, kTickSize) + kMargin);
  }
  const double width = box.right + legend;
  const double legend_height = kTop + kLegendStep * static_cast<double>(series.size()) + kMargin;
  SvgWriter svg(width, std::max(kHeight, legend_height));
  const double room = width - box.left - kMargin;
  const double size = std::min(kTitleSize, kTitleSize * room / TextWidth(title + " ", kTitleSize));
  svg.Text(box.left, kTop - 20, title, TextAnchor::kStart, size, "font-weight=\"bold\"");
  return svg;
}

LegendPlace LegendSample(const Box& box, size_t index) {
  return {box.right + kLegendSample, box.top + 8 + kLegendStep * static_cast<double>(index)};
}

void DrawLegendText(const Box& box, size_t index, const std::string& name, SvgWriter* svg) {
  svg->Text(box.right + kLegendText, LegendSample(box, index).y + 4, name, TextAnchor::kStart,
            kTickSize);
}

}  // namespace duet::evaluation::report
