#include "server/lifecycle/self_check.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "server/common/mutex.h"
#include "tests/server/support/running_service.h"
#include "tests/support/status_matchers.h"

namespace duet::server::lifecycle {
namespace {

using test::IsOk;
using test::StatusIs;

using ::testing::HasSubstr;

using absl::StatusCode;

// A socket that listens on this machine; whether anybody accepts is the test's affair.
class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    EXPECT_EQ(listen(socket_, 4), 0);
    socklen_t size = sizeof(address);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { Close(); }
  void Close() {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  int Accept() const { return accept(socket_, nullptr, nullptr); }
  // Accept fails from now on.
  void Stop() const { shutdown(socket_, SHUT_RDWR); }
  int port() const { return port_; }

 private:
  int socket_;
  int port_ = 0;
};

TEST(CheckListenerTest, AServerThatAnswersIsWell) {
  test::RunningService running;
  const std::string address = running.address();
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  EXPECT_THAT(CheckListener("127.0.0.1", port, 60), IsOk());
  EXPECT_THAT(CheckListener("0.0.0.0", port, 60), IsOk()) << "every interface, this machine's too";
}

// What is left of gRPC's listener once it has run out of descriptors.
TEST(CheckListenerTest, AListenerThatNobodyAcceptsFromIsNot) {
  const Listener listener;
  EXPECT_THAT(CheckListener("127.0.0.1", listener.port(), 0.05),
              StatusIs(StatusCode::kUnavailable, HasSubstr("connected, but nobody answers")));
}

TEST(CheckListenerTest, AServerThatHangsUpIsThere) {
  const Listener listener;
  std::thread server([&] { close(listener.Accept()); });
  EXPECT_THAT(CheckListener("127.0.0.1", listener.port(), 60), IsOk());
  server.join();
}

TEST(CheckListenerTest, APortThatNobodyListensOnIsSaidSo) {
  Listener listener;
  listener.Close();
  EXPECT_THAT(CheckListener("127.0.0.1", listener.port(), 60),
              StatusIs(StatusCode::kUnavailable, HasSubstr("cannot connect")));
}

TEST(SelfCheckTest, IsUnhealthyAfterThreeFailuresAndWellAgainAfterASuccess) {
  common::Mutex mutex;
  common::CondVar changed;
  int failures = 0;
  Listener silent;
  SelfCheckOptions options;
  options.host = "127.0.0.1";
  options.port = silent.port();
  options.interval_seconds = 0.001;
  options.timeout_seconds = 0.001;
  options.failed = [&](const absl::Status&) {
    common::MutexLock lock(mutex);
    ++failures;
    changed.NotifyAll();
  };
  SelfCheck check(options);
  EXPECT_TRUE(check.healthy());
  {
    common::MutexLock lock(mutex);
    while (failures < 3) changed.Wait(mutex);
  }
  EXPECT_FALSE(check.healthy());
  std::thread server([&] {
    for (int socket; (socket = silent.Accept()) >= 0;) close(socket);
  });
  while (!check.healthy()) std::this_thread::yield();
  silent.Stop();
  server.join();
}

}  // namespace
}  // namespace duet::server::lifecycle
