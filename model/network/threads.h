#ifndef DUET_MODEL_NETWORK_THREADS_H_
#define DUET_MODEL_NETWORK_THREADS_H_

#include "absl/status/status.h"

namespace duet::network {

// Sets the number of threads on which LibTorch runs one operation. Call it once, before any other
// use of LibTorch. Errors: INTERNAL if LibTorch cannot identify the processor (it reads
// /proc/cpuinfo).
absl::Status SetThreads(int threads);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_THREADS_H_
