#include "server/common/bindable.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "tests/support/matchers.h"

namespace duet::server::common {
namespace {

// A socket bound to a port of 127.0.0.1.
class BoundSocket {
 public:
  BoundSocket() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    socklen_t size = sizeof(address);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~BoundSocket() { close(socket_); }
  void Listen() { EXPECT_EQ(listen(socket_, 1), 0); }
  int port() const { return port_; }

 private:
  const int socket_;
  int port_ = 0;
};

TEST(BindableTest, FreePortIsBindable) {
  EXPECT_THAT(CheckBindable("127.0.0.1", 0), IsOk());
  EXPECT_THAT(CheckBindable("0.0.0.0", 0), IsOk());
  EXPECT_THAT(CheckBindable("localhost", 0), IsOk());
  EXPECT_THAT(CheckBindable("::", 0), IsOk()) << "with and without IPv6";
}

TEST(BindableTest, PortWithAListenerIsReportedAsInUse) {
  BoundSocket other;
  EXPECT_THAT(CheckBindable("127.0.0.1", other.port()), IsOk()) << "nobody listens yet";
  other.Listen();
  const std::string address = absl::StrCat("127.0.0.1:", other.port());
  const auto in_use = StatusIs(
      absl::StatusCode::kAlreadyExists,
      StartsWith("expected a free port, got " + address + ", which is in use; \"ss -tanp"));
  EXPECT_THAT(CheckBindable("127.0.0.1", other.port()), in_use);
  EXPECT_THAT(CheckBindable("0.0.0.0", other.port()).code(), absl::StatusCode::kAlreadyExists);
  EXPECT_THAT(ListenFailure("127.0.0.1", other.port()),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("which is in use")));
}

TEST(BindableTest, CheckDoesNotBlockThePort) {
  BoundSocket server;
  ASSERT_THAT(CheckBindable("127.0.0.1", server.port()), IsOk());
  server.Listen();
}

TEST(BindableTest, ErrorNamesAHostThatDoesNotResolve) {
  // RFC 6761: never resolves.
  EXPECT_THAT(CheckBindable("nowhere.invalid", 1),
              StatusIs(absl::StatusCode::kNotFound,
                       StartsWith("expected a host name that resolves, or an IP address, got "
                                  "\"nowhere.invalid\" (")));
}

TEST(BindableTest, ErrorNamesAnAddressOfAnotherMachine) {
  // RFC 5737: for documentation.
  EXPECT_THAT(CheckBindable("203.0.113.5", 50051),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       AllOf(StartsWith("expected an address of this machine, got "
                                        "203.0.113.5:50051 ("),
                             HasSubstr("0.0.0.0"))));
}

// Exits the process as a user who may not listen on ports below 1024: 0 if the error has the
// reason.
[[noreturn]] void ListenOnPortOneWithoutRights() {
  constexpr uid_t kNobody = 65534;
  if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) _exit(2);
  const absl::Status refused = CheckBindable("127.0.0.1", 1);
  const bool says_why =
      absl::IsPermissionDenied(refused) &&
      absl::StartsWith(refused.message(),
                       "expected a port that this user may listen on, got 127.0.0.1:1 (Permission "
                       "denied)") &&
      absl::StrContains(refused.message(), "CAP_NET_BIND_SERVICE");
  _exit(says_why ? 0 : 1);
}

TEST(BindableTest, ErrorNamesAPrivilegedPort) {
  int first_free_for_all = 0;
  std::ifstream("/proc/sys/net/ipv4/ip_unprivileged_port_start") >> first_free_for_all;
  if (first_free_for_all < 2) {
    GTEST_SKIP() << "every user may listen on port 1 here (ip_unprivileged_port_start is "
                 << first_free_for_all << ")";
  }
  EXPECT_EXIT(ListenOnPortOneWithoutRights(), ::testing::ExitedWithCode(0), "");
}

TEST(BindableTest, ReportsThatThePortHasBecomeFree) {
  EXPECT_THAT(ListenFailure("127.0.0.1", 0),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("try again")));
}

}  // namespace
}  // namespace duet::server::common
