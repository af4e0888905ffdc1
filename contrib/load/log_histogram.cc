#include "contrib/load/log_histogram.h"

#include <algorithm>
#include <cmath>

namespace duet::contrib::load {
namespace {

constexpr int kBucketBits = 6;  // 64 buckets for each doubling
constexpr int64_t kBuckets = int64_t{1} << kBucketBits;
constexpr int64_t kLargest = int64_t{1} << 62;

// The highest set bit of a value >= 1.
int HighestBit(int64_t value) { return 63 - __builtin_clzll(static_cast<uint64_t>(value)); }

// Below 2 * kBuckets a value is its own bucket; above, the highest bit gives the doubling and the
// next kBucketBits the part of it.
std::size_t BucketOf(int64_t value) {
  if (value < 2 * kBuckets) return static_cast<std::size_t>(value);
  const int shift = HighestBit(value) - kBucketBits;
  return static_cast<std::size_t>(shift * kBuckets + (value >> shift));
}

// The middle of a bucket's values.
int64_t MiddleOf(std::size_t bucket) {
  const auto index = static_cast<int64_t>(bucket);
  if (index < 2 * kBuckets) return index;
  const int64_t shift = index / kBuckets - 1;
  const int64_t low = (index - shift * kBuckets) << shift;
  return low + ((int64_t{1} << shift) - 1) / 2;
}

}  // namespace

void LogHistogram::Add(int64_t value) {
  value = std::clamp(value, int64_t{0}, kLargest);
  const std::size_t bucket = BucketOf(value);
  if (bucket >= counts_.size()) counts_.resize(bucket + 1);
  ++counts_[bucket];
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = std::max(max_, value);
  sum_ += static_cast<double>(value);
  ++count_;
}

void LogHistogram::Add(const LogHistogram& other) {
  if (other.count_ == 0) return;
  counts_.resize(std::max(counts_.size(), other.counts_.size()));
  for (std::size_t i = 0; i < other.counts_.size(); ++i) counts_[i] += other.counts_[i];
  min_ = count_ == 0 ? other.min_ : std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  sum_ += other.sum_;
  count_ += other.count_;
}

double LogHistogram::mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }

int64_t LogHistogram::Percentile(double percent) const {
  if (count_ == 0) return 0;
  const double exact = percent / 100 * static_cast<double>(count_);
  // Rounding must not turn rank 999 of 1,000 into 1,000.
  const auto rank = std::max(int64_t{1}, static_cast<int64_t>(std::ceil(exact - 1e-9)));
  if (rank == 1) return min_;
  if (rank >= count_) return max_;
  int64_t seen = 0;
  for (std::size_t bucket = 0; bucket < counts_.size(); ++bucket) {
    seen += counts_[bucket];
    if (seen >= rank) return std::clamp(MiddleOf(bucket), min_, max_);
  }
  return max_;
}

}  // namespace duet::contrib::load
