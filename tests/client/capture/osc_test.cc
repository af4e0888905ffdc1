#include "client/capture/osc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/client/capture/datagrams.h"
#include "tests/support/matchers.h"

namespace duet::client::capture {
namespace {

std::vector<std::string> AddressesIn(absl::string_view datagram) {
  std::vector<std::string> addresses;
  const absl::Status status = ForEachOscMessage(datagram, [&](const OscMessage& message) {
    addresses.emplace_back(message.address);
    return absl::OkStatus();
  });
  EXPECT_TRUE(status.ok()) << status;
  return addresses;
}

absl::Status Visit(absl::string_view datagram) {
  return ForEachOscMessage(datagram, [](const OscMessage&) { return absl::OkStatus(); });
}

TEST(OscTest, ReadsABundleWrittenByTheLayout) {
  const std::string datagram = test::VmcDatagram({2.5f, {{"Hips", {1, 2, 3}}}});
  EXPECT_THAT(AddressesIn(datagram), ElementsAre("/VMC/Ext/T", "/VMC/Ext/Bone/Pos"));
  std::vector<OscArgument> arguments;
  ASSERT_TRUE(ForEachOscMessage(datagram, [&](const OscMessage& message) {
                arguments = *ReadOscArguments(message);
                return absl::OkStatus();
              }).ok());
  ASSERT_EQ(arguments.size(), 8u);
  EXPECT_EQ(arguments[0].text, "Hips");
  EXPECT_EQ(arguments[2].number, 2);
  EXPECT_EQ(arguments[7].number, 1);
}

TEST(OscTest, WritesWhatItReads) {
  OscBundle bundle;
  EXPECT_TRUE(bundle.empty());
  bundle.Begin("/a", "isf");
  bundle.Add(-7);
  bundle.Add("four");
  bundle.Add(0.25f);
  bundle.Begin("/b", "");
  EXPECT_THAT(AddressesIn(bundle.bytes()), ElementsAre("/a", "/b"));
  const absl::Status status = ForEachOscMessage(bundle.bytes(), [](const OscMessage& message) {
    const auto arguments = ReadOscArguments(message);
    EXPECT_TRUE(arguments.ok());
    if (message.address == "/a") {
      EXPECT_EQ((*arguments)[0].number, -7);
      EXPECT_EQ((*arguments)[1].text, "four");
      EXPECT_EQ((*arguments)[2].number, 0.25);
    }
    return arguments.status();
  });
  EXPECT_TRUE(status.ok()) << status;
}

TEST(OscTest, AMessageWithoutABundleIsADatagram) {
  EXPECT_THAT(AddressesIn(std::string("/a\0\0,\0\0\0", 8)), ElementsAre("/a"));
}

TEST(OscTest, RejectsDatagramsCutAnywhere) {
  const std::string whole = test::VmcDatagram({2.5f, {{"Hips"}}});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    if (size == 16 || size == 40) continue;  // bundles of no and of one message
    EXPECT_FALSE(Visit(whole.substr(0, size)).ok()) << size;
  }
}

TEST(OscTest, RejectsBundlesInTooManyBundles) {
  std::string datagram("/a\0\0,\0\0\0", 8);
  for (int depth = 0; depth <= kMaxOscDepth; ++depth) {
    EXPECT_EQ(Visit(datagram).ok(), depth <= kMaxOscDepth) << depth;
    datagram = absl::StrCat(absl::string_view("#bundle\0\0\0\0\0\0\0\0\1\0\0\0", 19),
                            std::string(1, static_cast<char>(datagram.size())), datagram);
  }
  EXPECT_THAT(std::string(Visit(datagram).message()), HasSubstr("levels of bundles"));
}

TEST(OscTest, RejectsMoreArgumentsThanItReads) {
  OscBundle bundle;
  bundle.Begin("/a", std::string(kMaxOscArguments + 1, 'T'));
  const absl::Status status = ForEachOscMessage(
      bundle.bytes(), [](const OscMessage& message) { return ReadOscArguments(message).status(); });
  EXPECT_THAT(std::string(status.message()), HasSubstr("at most 64 arguments, got 65"));
}

}  // namespace
}  // namespace duet::client::capture
