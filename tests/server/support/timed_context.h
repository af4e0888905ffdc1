#ifndef DUET_TESTS_SERVER_SUPPORT_TIMED_CONTEXT_H_
#define DUET_TESTS_SERVER_SUPPORT_TIMED_CONTEXT_H_

#include <grpcpp/client_context.h>

#include <chrono>

namespace duet::test {

// Far longer than any call of a test takes: a call that never ends fails its test instead of
// hanging it.
inline constexpr std::chrono::seconds kCallLimit(60);

// Gives a call a deadline.
inline void LimitCall(grpc::ClientContext& context) {
  context.set_deadline(std::chrono::system_clock::now() + kCallLimit);
}

// A client's context with that deadline, unless the test sets another one.
class TimedContext final : public grpc::ClientContext {
 public:
  TimedContext() { LimitCall(*this); }
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_TIMED_CONTEXT_H_
