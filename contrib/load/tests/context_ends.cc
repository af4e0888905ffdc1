#include "contrib/load/tests/context_ends.h"

#include <memory>
#include <mutex>
#include <utility>

#include "grpcpp/client_context.h"

namespace duet::test {
namespace {

// gRPC takes one object for the whole process, and never releases it.
class Hook final : public grpc::ClientContext::GlobalCallbacks {
 public:
  static Hook& Installed() {
    static Hook* const hook = [] {
      auto* const made = new Hook;
      grpc::ClientContext::SetGlobalCallbacks(made);
      return made;
    }();
    return *hook;
  }

  void Set(std::function<void()> on_end) {
    const std::lock_guard<std::mutex> lock(mutex_);
    on_end_ = on_end ? std::make_shared<const std::function<void()>>(std::move(on_end)) : nullptr;
  }
  void DefaultConstructor(grpc::ClientContext* /*context*/) override {}
  void Destructor(grpc::ClientContext* /*context*/) override {
    std::shared_ptr<const std::function<void()>> on_end;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      on_end = on_end_;
    }
    if (on_end != nullptr) (*on_end)();
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const std::function<void()>> on_end_;
};

}  // namespace

ContextEnds::ContextEnds(std::function<void()> on_end) { Hook::Installed().Set(std::move(on_end)); }
ContextEnds::~ContextEnds() { Hook::Installed().Set(nullptr); }

}  // namespace duet::test
