#include "client/live/latency.h"

#include <algorithm>
#include <cstddef>

namespace duet::client::live {
namespace {

// The nearest-rank percentile. Reorders `values`, which are not empty.
absl::Duration Percentile(std::vector<absl::Duration>* values, std::size_t percent) {
  const std::size_t rank = (values->size() * percent + 99) / 100;
  const auto nth = values->begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values->begin(), nth, values->end());
  return *nth;
}

}  // namespace

void LatencyLog::Add(absl::Time now, absl::Duration latency) {
  if (entries_.size() < kKept) {
    entries_.push_back({now, latency});
    return;
  }
  entries_[next_] = {now, latency};
  next_ = (next_ + 1) % kKept;
}

Latencies LatencyLog::Since(absl::Time since) const {
  std::vector<absl::Duration> values;
  // From the newest entry back, so that the strip does not read the whole log.
  for (std::size_t age = 1; age <= entries_.size(); ++age) {
    const Entry& entry = entries_[(next_ + entries_.size() - age) % entries_.size()];
    if (entry.time < since) break;
    values.push_back(entry.latency);
  }
  if (values.empty()) return {};
  return {Percentile(&values, 50), Percentile(&values, 99)};
}

}  // namespace duet::client::live
