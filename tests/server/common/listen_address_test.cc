#include "server/common/listen_address.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

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
  for (const char* host : {"127.0.0.1", "0.0.0.0", "localhost", "::"}) {  // even without IPv6
    EXPECT_THAT(CheckBindable(host, 0), IsOk()) << host;
  }
}

TEST(BindableTest, PortWithAListenerIsReportedAsInUse) {
  BoundSocket other;
  EXPECT_THAT(CheckBindable("127.0.0.1", other.port()), IsOk()) << "nobody listens yet";
  other.Listen();
  const std::string address = absl::StrCat("127.0.0.1:", other.port());
  const auto in_use =
      StatusIs(absl::StatusCode::kAlreadyExists,
               StartsWith("expected a free port, got " + address + ", which is in use"));
  EXPECT_THAT(CheckBindable("127.0.0.1", other.port()), in_use);
  EXPECT_THAT(CheckBindable("0.0.0.0", other.port()).code(), absl::StatusCode::kAlreadyExists);
  EXPECT_THAT(ListenFailure("127.0.0.1", other.port()),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("which is in use")));
}

TEST(BindableTest, ErrorNamesAHostThatDoesNotResolveOrIsElsewhere) {
  // RFC 6761: never resolves.
  EXPECT_THAT(CheckBindable("nowhere.invalid", 1),
              StatusIs(absl::StatusCode::kNotFound,
                       StartsWith("expected a host name that resolves, or an IP address, got "
                                  "\"nowhere.invalid\" (")));
  // RFC 5737: for documentation.
  EXPECT_THAT(CheckBindable("203.0.113.5", 50051),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       AllOf(StartsWith("expected an address of this machine"),
                             HasSubstr("got 203.0.113.5:50051 ("))));
}

TEST(BindableTest, ReportsThatThePortHasBecomeFree) {
  EXPECT_THAT(ListenFailure("127.0.0.1", 0),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("try again")));
}

TEST(ListenAddressTest, ParsesHostAndPort) {
  for (const char* text : {"0.0.0.0:50051", "localhost:0", "[::]:9464", "10.1.2.3:65535"}) {
    const absl::StatusOr<ListenAddress> address = ParseListenAddress(text);
    ASSERT_THAT(address, IsOk()) << text;
    EXPECT_EQ(ToString(*address), text);
  }
  EXPECT_EQ(ToString(*ParseListenAddress(":80")), "0.0.0.0:80");
}

TEST(ListenAddressTest, RejectsMalformedAddresses) {
  for (const char* text : {"", "localhost", "localhost:", "localhost:-1", "localhost:65536",
                           "localhost:http", "::1:80", "[::1]", "[::1:80"}) {
    EXPECT_THAT(ParseListenAddress(text),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("host:port")))
        << text;
  }
}

}  // namespace
}  // namespace duet::server::common
