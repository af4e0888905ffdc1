#include <gtest/gtest.h>

#include <set>
#include <string>

#include "model/base/request_id.h"
#include "server/service/call_pipeline.h"

namespace duet::server::service {
namespace {

TEST(RequestIdTest, MakesDistinctOnes) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = NewRequestId();
    EXPECT_EQ(id.size(), 32u);
    EXPECT_TRUE(base::IsRequestId(id));
    ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 1000u);
}

TEST(TraceparentTest, AcceptsTheW3cForm) {
  EXPECT_TRUE(IsTraceparent("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"));
}

TEST(TraceparentTest, RefusesAnythingElse) {
  EXPECT_FALSE(IsTraceparent(""));
  EXPECT_FALSE(IsTraceparent("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-0"));
  EXPECT_FALSE(IsTraceparent("00-4BF92F3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"));
  EXPECT_FALSE(IsTraceparent("00-4bf92f3577b34da6a3ce929d0e0e473g-00f067aa0ba902b7-01"));
  EXPECT_FALSE(IsTraceparent("00x4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"));
}

TEST(ClientTest, IsAnAddressWithoutItsPort) {
  EXPECT_EQ(ClientOf("ipv4:192.0.2.7:4711"), "ipv4:192.0.2.7");
  EXPECT_EQ(ClientOf("ipv4:192.0.2.7:4712"), ClientOf("ipv4:192.0.2.7:4711"));
  EXPECT_NE(ClientOf("ipv4:192.0.2.8:4711"), ClientOf("ipv4:192.0.2.7:4711"));
}

TEST(ClientTest, IsANetworkOfIpv6) {
  EXPECT_EQ(ClientOf("ipv6:%5B2001:db8:1:2:3:4:5:6%5D:4711"), "ipv6:2001:db8:1:2::/64");
  EXPECT_EQ(ClientOf("ipv6:%5B2001:db8:1:2::9%5D:1"), "ipv6:2001:db8:1:2::/64");
  EXPECT_NE(ClientOf("ipv6:%5B2001:db8:1:3::9%5D:1"), "ipv6:2001:db8:1:2::/64");
}

TEST(ClientTest, Ipv4MappedAddressCountsAsIpv4) {
  EXPECT_EQ(ClientOf("ipv6:%5B::ffff:192.0.2.7%5D:4711"), "ipv4:192.0.2.7");
}

TEST(ClientTest, OfAnythingElseIsThePeer) {
  EXPECT_EQ(ClientOf("unix:/run/duet.sock"), "unix:/run/duet.sock");
  EXPECT_EQ(ClientOf(""), "");
  EXPECT_EQ(ClientOf("ipv6:nonsense"), "ipv6");
}

}  // namespace
}  // namespace duet::server::service
