#ifndef DUET_MODEL_EVALUATION_REPORT_SVG_H_
#define DUET_MODEL_EVALUATION_REPORT_SVG_H_

#include <cstddef>
#include <string>
#include <vector>

namespace duet::evaluation::report {

// Which point of a text stands at its position.
enum class TextAnchor { kStart, kMiddle, kEnd };

// Writes an SVG document piece by piece. Units: pixels, y down.
class SvgWriter {
 public:
  SvgWriter(double width, double height);

  void Line(double x0, double y0, double x1, double y1, const std::string& style);
  // `path` is the content of a d attribute.
  void Path(const std::string& path, const std::string& style);
  // A path that moves through `frames` (paths of like commands, one or more) in `seconds` and
  // starts over; where pictures do not move, `still` is seen. SMIL: no script.
  void MovingPath(const std::string& still, const std::vector<std::string>& frames, double seconds,
                  const std::string& style);
  void Text(double x, double y, const std::string& text, TextAnchor anchor, double size,
            const std::string& style = "");
  // The same, turned to read upwards.
  void TextUpwards(double x, double y, const std::string& text, double size);
  // The marker of a series around a point.
  void Marker(std::size_t series, double x, double y, double radius);

  // The whole document.
  std::string Finish() const;

 private:
  std::string text_;
};

// The colour and the dash pattern of a series; both repeat after eight.
std::string SeriesColour(std::size_t series);
std::string SeriesDash(std::size_t series);

// A number for an attribute: at most two decimals, never an exponent.
std::string SvgNumber(double value);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_SVG_H_
