#ifndef DUET_MODEL_NETWORK_EXCEPTIONS_H_
#define DUET_MODEL_NETWORK_EXCEPTIONS_H_

#include <functional>

#include "absl/status/status.h"

namespace duet::network {

// Does `work`, which uses LibTorch: LibTorch reports by exception, and this is where a program
// stops them. Gives what `work` gives. Errors: an exception becomes INTERNAL with its message,
// LibTorch's without the stack trace; too little memory RESOURCE_EXHAUSTED.
absl::Status CatchExceptions(const std::function<absl::Status()>& work);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_EXCEPTIONS_H_
