#ifndef DUET_CONTRIB_LOAD_TESTS_CONTEXT_ENDS_H_
#define DUET_CONTRIB_LOAD_TESTS_CONTEXT_ENDS_H_

#include <functional>

namespace duet::test {

// While it exists, calls a function whenever a grpc::ClientContext of this process is destroyed: on
// the thread that destroys it, before the context releases its connection.
//
// At most one may exist at a time. Create it while the process has no grpc::ClientContext.
class ContextEnds {
 public:
  explicit ContextEnds(std::function<void()> on_end);
  ContextEnds(const ContextEnds&) = delete;
  ContextEnds& operator=(const ContextEnds&) = delete;
  ~ContextEnds();
};

}  // namespace duet::test

#endif  // DUET_CONTRIB_LOAD_TESTS_CONTEXT_ENDS_H_
