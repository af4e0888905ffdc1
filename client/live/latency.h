#ifndef DUET_CLIENT_LIVE_LATENCY_H_
#define DUET_CLIENT_LIVE_LATENCY_H_

#include <cstddef>
#include <vector>

#include "absl/time/time.h"

namespace duet::client::live {

// Two percentiles of latencies.
struct Latencies {
  absl::Duration p50, p99;
};

// The latencies of the last frames, at most kKept of them.
class LatencyLog {
 public:
  static constexpr std::size_t kKept = std::size_t{1} << 18;

  void Add(absl::Time now, absl::Duration latency);
  // Of the frames since `since`. Zero without frames.
  Latencies Since(absl::Time since) const;
  Latencies All() const { return Since(absl::InfinitePast()); }

 private:
  struct Entry {
    absl::Time time;
    absl::Duration latency;
  };
  std::vector<Entry> entries_;  // a ring, once it is full
  std::size_t next_ = 0;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_LATENCY_H_
