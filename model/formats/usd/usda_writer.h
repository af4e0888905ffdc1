#ifndef DUET_MODEL_FORMATS_USD_USDA_WRITER_H_
#define DUET_MODEL_FORMATS_USD_USDA_WRITER_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

// Text USD (.usda) in the making, a line at a time.

namespace duet::formats::usd {

// A name as prims may have it: letters, digits and underscores, the first no digit.
std::string PrimName(absl::string_view name);
// Text in double quotes, whatever it holds.
std::string UsdString(absl::string_view text);

// Values as the format writes them. Turns have the real part first; matrices are of row vectors.
std::string UsdNumber(double value);
std::string UsdVector(retargeting::Vec3d a);
std::string UsdTurn(retargeting::Quaternion q);
std::string UsdTranslation(retargeting::Vec3d by);
// "[a, b, c]" of values that are written already.
std::string UsdArray(const std::vector<std::string>& values);

class UsdaWriter {
 public:
  // "#usda 1.0"
  UsdaWriter();

  // An indented line.
  void Line(absl::string_view text);
  // Ends the line with `bracket` ("{" or "("), and indents what follows until Close("}").
  void Open(absl::string_view text, char bracket = '{');
  void Close(absl::string_view bracket = "}");
  // "name.timeSamples = {", a line for each of `values`, of frames from 0 on.
  void TimeSamples(absl::string_view name, const std::vector<std::string>& values);

  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
  std::size_t depth_ = 0;
};

}  // namespace duet::formats::usd

#endif  // DUET_MODEL_FORMATS_USD_USDA_WRITER_H_
