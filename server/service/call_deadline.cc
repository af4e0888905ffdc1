#include "server/service/call_deadline.h"

#include <grpc/support/time.h>

#include <limits>

namespace duet::server::service {

double SecondsLeft(const grpc::ServerContextBase& context) {
  const gpr_timespec deadline = context.raw_deadline();
  if (gpr_time_cmp(deadline, gpr_inf_future(deadline.clock_type)) == 0) {
    return std::numeric_limits<double>::infinity();
  }
  const gpr_timespec left = gpr_time_sub(deadline, gpr_now(deadline.clock_type));
  return static_cast<double>(left.tv_sec) + 1e-9 * left.tv_nsec;
}

}  // namespace duet::server::service
