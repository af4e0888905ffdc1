#ifndef DUET_CLIENT_INTERNAL_UNREACHABLE_H_
#define DUET_CLIENT_INTERNAL_UNREACHABLE_H_

#include <string>

#include "absl/strings/string_view.h"

namespace duet::client::internal {

// Returns a sentence that says why gRPC had no server for a call to `address`, such as "the server
// at localhost:50051 is not running: it refused the connection". `message` is gRPC's own, which
// names sockets and system calls; it is part of the sentence only if its cause is unknown. The
// Python client has the same sentences (duet_motion/_unreachable.py).
std::string DescribeUnreachable(absl::string_view address, absl::string_view message);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_UNREACHABLE_H_
