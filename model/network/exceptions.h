#ifndef DUET_MODEL_NETWORK_EXCEPTIONS_H_
#define DUET_MODEL_NETWORK_EXCEPTIONS_H_

#include <functional>

#include "absl/status/status.h"

namespace duet::network {

// Runs `work`, which may throw LibTorch's exceptions, and returns its status. An exception becomes
// INTERNAL with its message (LibTorch's without the stack trace), and std::bad_alloc
// RESOURCE_EXHAUSTED.
absl::Status CatchExceptions(const std::function<absl::Status()>& work);

// Sets the number of threads on which LibTorch runs one operation. Call it once, before any other
// use of LibTorch. Errors: INTERNAL if LibTorch cannot identify the processor (it reads
// /proc/cpuinfo).
absl::Status SetThreads(int threads);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_EXCEPTIONS_H_
