#ifndef DUET_SERVER_LIFECYCLE_HEAP_TRIMMER_H_
#define DUET_SERVER_LIFECYCLE_HEAP_TRIMMER_H_

#include <cstddef>
#include <cstdint>
#include <functional>

namespace duet::server::lifecycle {

// Makes the heap return freed memory to the system. Call it before other threads start.
//
// By default glibc adapts its mmap threshold to the sizes that it has seen freed, and with it the
// amount that may stay free at the end of each thread's heap, up to 64 MiB; HeapTrimmer cannot
// release that part. The memory of a server would then depend on which thread served which request.
// glibc also allows eight heaps for each core, each with partly used pages; this function allows
// two.
void LimitFreeMemory();

// Returns the memory of large requests to the system. glibc keeps freed memory, above all free
// pages between blocks that are still in use: after a burst of large requests it would keep
// hundreds of megabytes forever.
//
// Threads: not safe to call concurrently.
class HeapTrimmer {
 public:
  HeapTrimmer();
  // `trim` replaces malloc_trim, for tests.
  explicit HeapTrimmer(std::function<void()> trim);

  // Call it about once a second with the bytes of all large requests so far and the bytes that
  // calls hold now. Trims if large requests arrived or finished, and once more at the next call,
  // because the memory of the last request is freed a little later.
  void Look(std::uint64_t received_bytes, std::size_t held_bytes);

 private:
  const std::function<void()> trim_;
  std::uint64_t received_bytes_ = 0;
  std::size_t held_bytes_ = 0;
  bool once_more_ = false;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_HEAP_TRIMMER_H_
