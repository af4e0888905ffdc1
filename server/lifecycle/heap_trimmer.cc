#include "server/lifecycle/heap_trimmer.h"

#include <malloc.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace duet::server::lifecycle {
namespace {

// Trimming walks the whole heap; less than this is not worth it.
constexpr std::size_t kWorthIt = std::size_t{1} << 20;

// Blocks of at least this size are mapped individually, and at most this much stays free at the end
// of a heap. Short clips need less, so that they do not request memory from the system.
constexpr int kKeptBytes = 1 << 20;

}  // namespace

void LimitFreeMemory() {
  mallopt(M_MMAP_THRESHOLD, kKeptBytes);
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
  mallopt(M_ARENA_MAX, 2 * static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

HeapTrimmer::HeapTrimmer() : HeapTrimmer([] { malloc_trim(0); }) {}

HeapTrimmer::HeapTrimmer(std::function<void()> trim) : trim_(std::move(trim)) {}

void HeapTrimmer::Look(std::uint64_t received_bytes, std::size_t held_bytes) {
  const bool came = received_bytes != received_bytes_;
  const bool went = held_bytes + kWorthIt <= held_bytes_;
  // Small requests do not change held_bytes_, so that they never add up to a trim.
  if (came || went || held_bytes > held_bytes_) held_bytes_ = held_bytes;
  received_bytes_ = received_bytes;
  if (came || went || once_more_) trim_();
  once_more_ = came || went;
}

}  // namespace duet::server::lifecycle
