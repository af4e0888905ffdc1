#ifndef DUET_MODEL_FORMATS_FLAT_NPY_ARRAY_H_
#define DUET_MODEL_FORMATS_FLAT_NPY_ARRAY_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"

// NumPy's array file, versions 1.0 to 3.0 (numpy.lib.format), without a meaning of its values.

namespace duet::formats::flat {

// The header as it is written, and the bytes after it.
struct NpyHeader {
  std::string descr;          // with its quotes: "'<f4'"
  std::string fortran_order;  // "False"
  std::vector<int> shape;
  absl::string_view values;  // refers to the parsed bytes
};

// Checks the form of the header, not its values.
// Errors: INVALID_ARGUMENT naming `source`.
absl::StatusOr<NpyHeader> ParseNpyHeader(absl::string_view bytes, absl::string_view source);

// An array of numbers in C or Fortran order. Refers to the parsed bytes.
class NpyNumbers {
 public:
  // Accepts float32, float64 and integers of 4 and 8 bytes, little-endian.
  // Errors: INVALID_ARGUMENT naming `source`, also if the values are not as many as the shape says.
  static absl::StatusOr<NpyNumbers> Parse(absl::string_view bytes, absl::string_view source);

  const std::vector<int>& shape() const { return header_.shape; }
  std::size_t size() const { return size_; }
  // The value at an index in C order, less than size(). It may be infinite or NaN.
  double at(std::size_t index) const;

 private:
  NpyHeader header_;
  std::size_t size_ = 0;
  std::size_t value_bytes_ = 0;
  bool fortran_order_ = false;
};

// float32 in C order. Requires as many values as the shape says.
std::string FormatNpyArray(const std::vector<int>& shape, absl::Span<const float> values);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_NPY_ARRAY_H_
