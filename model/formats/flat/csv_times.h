#ifndef DUET_MODEL_FORMATS_FLAT_CSV_TIMES_H_
#define DUET_MODEL_FORMATS_FLAT_CSV_TIMES_H_

#include <cstddef>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::formats::flat {

// Infers the frame rate from a column of times in seconds.
class CsvTimes {
 public:
  // Adds the time of the next frame.
  void Add(absl::string_view text);

  // The rate in Hz; 0 if the times are not even steps. Within the rounding of the times, the rate
  // snaps to the nearest usual one, or else to an integer.
  double FrameRate() const;

 private:
  double Meant(double rate) const;

  std::vector<double> seconds_;
  std::size_t decimals_ = 0;
  bool readable_ = true;
};

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_CSV_TIMES_H_
