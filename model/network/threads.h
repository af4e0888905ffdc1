#ifndef DUET_MODEL_NETWORK_THREADS_H_
#define DUET_MODEL_NETWORK_THREADS_H_

#include "absl/status/status.h"

namespace duet::network {

// How many threads LibTorch runs one operation on. Once, at start, before any other use.
// Errors: INTERNAL where LibTorch cannot find out about the processor: it reads /proc/cpuinfo.
absl::Status SetThreads(int threads);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_THREADS_H_
