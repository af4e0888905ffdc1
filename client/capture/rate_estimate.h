#ifndef DUET_CLIENT_CAPTURE_RATE_ESTIMATE_H_
#define DUET_CLIENT_CAPTURE_RATE_ESTIMATE_H_

#include <optional>
#include <vector>

namespace duet::client::capture {

// Measures the frame rate of a stream from the times of its first frames: the sender's, or those of
// their arrival.
class RateEstimate {
 public:
  // Above this, every second (third, ...) frame is left out.
  static constexpr double kMaxRateHz = 120;

  void Add(double seconds);
  // In Hz, after a second of at least kMinFrames frames. A usual rate (30, 60, ...) if the measured
  // one is near it.
  std::optional<double> rate_hz() const;

 private:
  static constexpr std::size_t kMinFrames = 10, kMaxFrames = 500;
  std::vector<double> times_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_RATE_ESTIMATE_H_
