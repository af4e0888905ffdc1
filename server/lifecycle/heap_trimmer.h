#ifndef DUET_SERVER_LIFECYCLE_HEAP_TRIMMER_H_
#define DUET_SERVER_LIFECYCLE_HEAP_TRIMMER_H_

#include <cstddef>
#include <cstdint>
#include <functional>

namespace duet::server::lifecycle {

// Has the heap give back what is freed rather than keep it: to be called before there are threads.
//
// Left to itself glibc raises the size above which a block is mapped by itself, and with it what
// may stay free at the end of each thread's heap, up to 64 MiB, after the sizes that it has seen
// freed; HeapTrimmer cannot reach that part. What a server holds would then depend on which thread
// served which request. It would also have eight heaps a core for its threads, each with pages that
// are used in part; there are two a core here.
void LimitFreeMemory();

// Gives memory of large requests back to the system. glibc keeps what is freed for later, pages
// among blocks that are still used above all: after a burst of large requests that is hundreds of
// megabytes, for good.
//
// Threads: not safe to call concurrently.
class HeapTrimmer {
 public:
  HeapTrimmer();
  // `trim` in place of the system's.
  explicit HeapTrimmer(std::function<void()> trim);

  // To be called about once a second, with the bytes of all large requests so far and those that
  // calls hold now. Trims when large requests came or went, and once more after that: what the last
  // of them held is freed a little later.
  void Look(std::uint64_t received_bytes, std::size_t held_bytes);

 private:
  const std::function<void()> trim_;
  std::uint64_t received_bytes_ = 0;
  std::size_t held_bytes_ = 0;
  bool once_more_ = false;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_HEAP_TRIMMER_H_
