#include "model/network/exceptions.h"

#include <ATen/Parallel.h>
#include <c10/util/Exception.h>

#include <exception>
#include <new>

#include "absl/strings/str_cat.h"

namespace duet::network {
absl::Status CatchExceptions(const std::function<absl::Status()>& work) {
  try {
    return work();
  } catch (const c10::Error& error) {
    return absl::InternalError(absl::StrCat("LibTorch failed: ", error.what_without_backtrace()));
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory");
  } catch (const std::exception& error) {
    return absl::InternalError(error.what());
  }
}

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
