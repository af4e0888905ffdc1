#ifndef DUET_CONTRIB_LOAD_LOG_HISTOGRAM_H_
#define DUET_CONTRIB_LOAD_LOG_HISTOGRAM_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace duet::contrib::load {

// Counts values in buckets that grow with the value, so that a run of any length takes the same
// memory (at most 38 kB) and every percentile is off by less than 0.8 %: 64 equal buckets for each
// doubling, one for each value below 128.
//
// Values: integers from 0 to 2^62, in a unit of the user's choice. Smaller values count as 0,
//         larger ones as the largest.
// Threads: as an int.
class LogHistogram {
 public:
  void Add(int64_t value);
  void Add(const LogHistogram& other);

  int64_t count() const { return count_; }
  // 0 if empty. Exact, like the mean.
  int64_t min() const { return min_; }
  int64_t max() const { return max_; }
  double mean() const;

  // The smallest value that at least `percent` of all values do not exceed (nearest rank), as the
  // middle of its bucket: 0 gives the smallest value, 100 the largest. 0 if empty.
  int64_t Percentile(double percent) const;

 private:
  std::vector<int64_t> counts_;  // sized for the largest value
  int64_t count_ = 0;
  int64_t min_ = 0;
  int64_t max_ = 0;
  double sum_ = 0;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LOG_HISTOGRAM_H_
