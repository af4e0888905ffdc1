#include "model/evaluation/report/svg.h"

#include <cstdio>

#include "model/evaluation/report/markup.h"

namespace duet::evaluation::report {
namespace {

// Okabe and Ito 2008, without the yellow that white paper swallows.
constexpr const char* kColours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                    "#E69F00", "#56B4E9", "#000000", "#7F7F7F"};
constexpr const char* kDashes[] = {"none", "8 3",     "2 3",     "8 3 2 3",
                                   "14 4", "5 2 1 2", "1 2 6 2", "4 6"};
constexpr std::size_t kStyles = sizeof(kColours) / sizeof(kColours[0]);
constexpr char kFont[] = "Helvetica, Arial, 'DejaVu Sans', sans-serif";

std::string Point(double x, double y) { return SvgNumber(x) + ' ' + SvgNumber(y); }

// Corners of a marker of radius 1, as dx, dy pairs; circles are drawn as such.
struct Polygon {
  int corners;
  double at[8][2];
};
constexpr Polygon kMarkers[] = {
    {0, {}},                                                              // circle
    {4, {{-.85, -.85}, {.85, -.85}, {.85, .85}, {-.85, .85}}},            // square
    {3, {{0, -1.15}, {1.05, .8}, {-1.05, .8}}},                           // triangle up
    {4, {{0, -1.2}, {1.2, 0}, {0, 1.2}, {-1.2, 0}}},                      // diamond
    {3, {{0, 1.15}, {1.05, -.8}, {-1.05, -.8}}},                          // triangle down
    {5, {{0, -1.15}, {1.1, -.3}, {.68, .95}, {-.68, .95}, {-1.1, -.3}}},  // pentagon
    {3, {{-1.15, 0}, {.8, -1.05}, {.8, 1.05}}},                           // triangle left
    {3, {{1.15, 0}, {-.8, -1.05}, {-.8, 1.05}}},                          // triangle right
};

const char* Name(TextAnchor anchor) {
  switch (anchor) {
    case TextAnchor::kStart:
      return "start";
    case TextAnchor::kMiddle:
      return "middle";
    case TextAnchor::kEnd:
      return "end";
  }
  return "start";
}

}  // namespace

std::string SeriesColour(std::size_t series) { return kColours[series % kStyles]; }
std::string SeriesDash(std::size_t series) { return kDashes[series % kStyles]; }

std::string SvgNumber(double value) {
  char text[400];
  std::snprintf(text, sizeof(text), "%.2f", value);
  std::string number = text;
  while (number.back() == '0') number.pop_back();
  if (number.back() == '.') number.pop_back();
  return number == "-0" ? "0" : number;
}

SvgWriter::SvgWriter(double width, double height) {
  const std::string size = SvgNumber(width) + "\" height=\"" + SvgNumber(height);
  text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
          Point(width, height) + "\" font-family=\"" + kFont + "\">\n<rect width=\"" + size +
          "\" fill=\"#ffffff\"/>\n";
}

void SvgWriter::Line(double x0, double y0, double x1, double y1, const std::string& style) {
  Path('M' + Point(x0, y0) + 'L' + Point(x1, y1), style);
}

void SvgWriter::Path(const std::string& path, const std::string& style) {
  text_ += "<path d=\"" + path + "\" " + style + "/>\n";
}

void SvgWriter::MovingPath(const std::string& still, const std::vector<std::string>& frames,
                           double seconds, const std::string& style) {
  text_ += "<path d=\"" + still + "\" " + style +
           "><animate attributeName=\"d\" repeatCount=\"indefinite\" dur=\"" + SvgNumber(seconds) +
           "s\" values=\"";
  for (std::size_t i = 0; i < frames.size(); ++i) text_ += (i == 0 ? "" : ";") + frames[i];
  text_ += "\"/></path>\n";
}

void SvgWriter::Text(double x, double y, const std::string& text, TextAnchor anchor, double size,
                     const std::string& style) {
  text_ += "<text x=\"" + SvgNumber(x) + "\" y=\"" + SvgNumber(y) + "\" font-size=\"" +
           SvgNumber(size) + "\" text-anchor=\"" + Name(anchor) + "\" fill=\"#222222\" " + style +
           '>' + EscapeMarkup(text) + "</text>\n";
}

void SvgWriter::TextUpwards(double x, double y, const std::string& text, double size) {
  Text(x, y, text, TextAnchor::kMiddle, size, "transform=\"rotate(-90 " + Point(x, y) + ")\"");
}

void SvgWriter::Marker(std::size_t series, double x, double y, double radius) {
  const std::string style = " fill=\"" + SeriesColour(series) +
                            "\" fill-opacity=\"0.8\" stroke=\"#ffffff\" stroke-width=\"0.6\"";
  const Polygon& marker = kMarkers[series % kStyles];
  if (marker.corners == 0) {
    text_ += "<circle cx=\"" + SvgNumber(x) + "\" cy=\"" + SvgNumber(y) + "\" r=\"" +
             SvgNumber(radius) + "\"" + style + "/>\n";
    return;
  }
  std::string path;
  for (int i = 0; i < marker.corners; ++i) {
    path +=
        (i == 0 ? 'M' : 'L') + Point(x + radius * marker.at[i][0], y + radius * marker.at[i][1]);
  }
  Path(path + 'Z', style);
}

std::string SvgWriter::Finish() const { return text_ + "</svg>\n"; }

}  // namespace duet::evaluation::report
