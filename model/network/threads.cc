#include "model/network/threads.h"

#include <ATen/Parallel.h>

#include "absl/strings/str_cat.h"
#include "model/network/exceptions.h"

namespace duet::network {

absl::Status SetThreads(int threads) {
  absl::Status status = CatchExceptions([threads] {
    at::set_num_threads(threads);
    return absl::OkStatus();
  });
  if (status.ok()) return status;
  return absl::InternalError(absl::StrCat("cannot choose the number of threads: ", status.message(),
                                          "; LibTorch reads /proc/cpuinfo: is it there?"));
}

}  // namespace duet::network
