#include "server/lifecycle/heap_trimmer.h"

#include <malloc.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace duet::server::lifecycle {
namespace {

// Less is not worth the walk through the heap.
constexpr std::size_t kWorthIt = std::size_t{1} << 20;

// Blocks from this size on are mapped by themselves, and no more than this stays free at the end of
// a heap. Larger than what short clips take, so that they do not go to the system for memory.
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
  // Small requests alone leave this where it was, so that their coming and going adds up to
  // nothing.
  if (came || went || held_bytes > held_bytes_) held_bytes_ = held_bytes;
  received_bytes_ = received_bytes;
  if (came || went || once_more_) trim_();
  once_more_ = came || went;
}

}  // namespace duet::server::lifecycle
