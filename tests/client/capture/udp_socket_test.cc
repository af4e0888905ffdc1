#include "client/capture/udp_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "client/capture/stream_reader.h"
#include "tests/support/matchers.h"

namespace duet::client::capture {
namespace {

constexpr double kPatience = 30;  // seconds; nothing waits for so long

void ExpectDelivery(const std::string& bind_to, const std::string& send_to) {
  const auto receiver = UdpReceiver::Bind(bind_to, 0);
  ASSERT_TRUE(receiver.ok()) << receiver.status();
  auto sender = UdpSender::Connect(send_to, (*receiver)->port());
  ASSERT_TRUE(sender.ok()) << sender.status();
  const std::string largest(kMaxDatagramBytes - 1000, 'x');
  for (const std::string& sent : {std::string("hello"), std::string(), largest}) {
    ASSERT_TRUE(sender->Send(sent).ok());
    const auto received = (*receiver)->Receive(kPatience);
    ASSERT_TRUE(received.ok()) << received.status();
    ASSERT_TRUE(received->has_value());
    EXPECT_EQ((*received)->bytes, sent);
  }
}

TEST(UdpSocketTest, DeliversOverIpv4) { ExpectDelivery("127.0.0.1", "127.0.0.1"); }

TEST(UdpSocketTest, DeliversOverIpv6) {
  if (!UdpReceiver::Bind("::1", 0).ok()) GTEST_SKIP() << "no IPv6 here";
  ExpectDelivery("::1", "::1");
  ExpectDelivery("", "::1");
}

TEST(UdpSocketTest, AllAddressesIncludeIpv4) { ExpectDelivery("", "127.0.0.1"); }

TEST(UdpSocketTest, TellsSendersApart) {
  const auto receiver = UdpReceiver::Bind("127.0.0.1", 0);
  ASSERT_TRUE(receiver.ok());
  auto a = UdpSender::Connect("127.0.0.1", (*receiver)->port());
  auto b = UdpSender::Connect("127.0.0.1", (*receiver)->port());
  ASSERT_TRUE(a.ok() && b.ok());
  std::vector<std::string> senders;
  for (UdpSender* sender : {&*a, &*b, &*a}) {
    ASSERT_TRUE(sender->Send("x").ok());
    senders.push_back((*(*receiver)->Receive(kPatience))->sender);
  }
  EXPECT_EQ(senders[0], senders[2]);
  EXPECT_NE(senders[0], senders[1]);
}

TEST(UdpSocketTest, StopEndsTheWaitOfAnotherThread) {
  const auto receiver = UdpReceiver::Bind("127.0.0.1", 0);
  ASSERT_TRUE(receiver.ok());
  EXPECT_FALSE((*receiver)->stopped());
  std::thread stopper([&] { (*receiver)->Stop(); });
  const auto received = (*receiver)->Receive(std::numeric_limits<double>::infinity());
  stopper.join();
  ASSERT_TRUE(received.ok());
  EXPECT_FALSE(received->has_value());
  EXPECT_TRUE((*receiver)->stopped());
}

TEST(UdpSocketTest, NamesAPortThatIsInUse) {
  const auto receiver = UdpReceiver::Bind("127.0.0.1", 0);
  ASSERT_TRUE(receiver.ok());
  const auto second = UdpReceiver::Bind("127.0.0.1", (*receiver)->port());
  EXPECT_THAT(std::string(second.status().message()),
              HasSubstr(std::to_string((*receiver)->port())));
}

TEST(UdpSocketTest, ADatagramToNobodyIsLost) {
  int port = 0;
  {
    const auto receiver = UdpReceiver::Bind("127.0.0.1", 0);
    ASSERT_TRUE(receiver.ok());
    port = (*receiver)->port();
  }
  auto sender = UdpSender::Connect("127.0.0.1", port);
  ASSERT_TRUE(sender.ok());
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sender->Send("x").ok());
}

}  // namespace
}  // namespace duet::client::capture
