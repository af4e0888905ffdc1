#ifndef DUET_MODEL_FORMATS_USD_USDA_WRITER_H_
#define DUET_MODEL_FORMATS_USD_USDA_WRITER_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

// Builds text USD (.usda) line by line.

namespace duet::formats::usd {

// Converts a name to a valid prim name: letters, digits and underscores; not a digit first.
std::string PrimName(absl::string_view name);
// Quotes any text with double quotes.
std::string UsdString(absl::string_view text);

// Format values. Rotations have the real part first; matrices apply to row vectors.
std::string UsdNumber(double value);
std::string UsdVector(retargeting::Vec3d a);
std::string UsdTurn(retargeting::Quaternion q);
std::string UsdTranslation(retargeting::Vec3d by);
// Joins formatted values to "[a, b, c]".
std::string UsdArray(const std::vector<std::string>& values);

class UsdaWriter {
 public:
  // "#usda 1.0"
  UsdaWriter();

  // Adds an indented line.
  void Line(absl::string_view text);
  // Adds a line that ends with `bracket` ("{" or "("), and indents the next lines until Close.
  void Open(absl::string_view text, char bracket = '{');
  void Close(absl::string_view bracket = "}");
  // Adds "name.timeSamples = {" with a line for each of `values`, at frames 0, 1, 2, ...
  void TimeSamples(absl::string_view name, const std::vector<std::string>& values);

  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
  std::size_t depth_ = 0;
};

}  // namespace duet::formats::usd

#endif  // DUET_MODEL_FORMATS_USD_USDA_WRITER_H_
