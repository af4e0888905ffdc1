#ifndef DUET_MODEL_FORMATS_FLAT_CSV_TIMES_H_
#define DUET_MODEL_FORMATS_FLAT_CSV_TIMES_H_

#include <cstddef>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::formats::flat {

// The rate of the times that frames were taken at, as a column of seconds has them.
class CsvTimes {
 public:
  // Of the next frame.
  void Add(absl::string_view text);

  // Hz; 0 where the times are no even steps in seconds. The nearest usual rate, or else a whole
  // one, counts as such within the times' own rounding.
  double FrameRate() const;

 private:
  double Meant(double rate) const;

  std::vector<double> seconds_;
  std::size_t decimals_ = 0;
  bool readable_ = true;
};

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_CSV_TIMES_H_
