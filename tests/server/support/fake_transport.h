#ifndef DUET_TESTS_SERVER_SUPPORT_FAKE_TRANSPORT_H_
#define DUET_TESTS_SERVER_SUPPORT_FAKE_TRANSPORT_H_

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <vector>

#include "server/service/call.h"

namespace duet::test {

// A caller that the test steps. `Reply` is the type of its replies.
template <typename Reply>
class FakeTransport final : public server::service::Transport {
 public:
  void Read() override { ++reads; }
  void Write(const google::protobuf::Message& reply) override {
    EXPECT_FALSE(writing) << "two writes at once";
    EXPECT_FALSE(finished.has_value()) << "a write after the end";
    writing = true;
    replies.push_back(dynamic_cast<const Reply&>(reply));
  }
  void Finish(server::service::CallScope& scope, const absl::Status& status) override {
    EXPECT_FALSE(writing) << "the end during a write";
    EXPECT_FALSE(finished.has_value()) << "two ends";
    scope.Finish(status);
    finished = status;
  }
  void BreakOff(const absl::Status& reason) override {
    ++broken_off;
    broken_off_with = reason;
    if (on_break_off) on_break_off();
  }

  // The reader took the message that is being written.
  void Written(server::service::Call& call, bool ok = true) {
    ASSERT_TRUE(writing);
    writing = false;
    call.OnWritten(ok);
  }

  int reads = 0;
  bool writing = false;
  int broken_off = 0;
  absl::Status broken_off_with;
  std::function<void()> on_break_off;
  std::vector<Reply> replies;
  std::optional<absl::Status> finished;
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_FAKE_TRANSPORT_H_
