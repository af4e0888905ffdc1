
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "server/config/container_limits.h"
#include "server/config/settings.h"
#include "tests/server/support/settings.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

using test::ResolveSettings;

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

v1::ServerConfig OptionsFor(std::uint64_t memory, const v1::ServerConfig& config = {},
                            int cores = 2) {
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(config, cores, {}, memory);
  EXPECT_THAT(options, IsOk());
  return options.ok() ? *options : v1::ServerConfig();
}

TEST(MemoryPlanTest, DefaultsFitSmallContainers) {
  for (std::uint64_t memory = 160; memory < 5000; memory += memory < 500 ? 8 : 100) {
    for (const int cores : {1, 2, 4}) {
      const v1::ServerConfig options = OptionsFor(memory * kMebibyte, {}, cores);
      EXPECT_LE(NeedOf(options).total(), memory * kMebibyte) << memory << " MiB, " << cores;
      EXPECT_THAT(MemoryWarnings(options, memory * kMebibyte), IsEmpty()) << memory;
    }
  }
}

TEST(MemoryPlanTest, AmpleMemoryGetsTheLargestLimits) {
  for (const std::uint64_t memory : {2048 * kMebibyte, kUnlimitedMemory}) {
    const v1::ServerConfig options = OptionsFor(memory);
    EXPECT_EQ(options.max_calls(), 128);
    EXPECT_EQ(options.max_request_bytes(), 32 * kMebibyte);
    EXPECT_EQ(options.max_transport_bytes(), 512 * kMebibyte);
    EXPECT_EQ(options.max_held_bytes(), 512 * kMebibyte);
    EXPECT_EQ(options.max_slow_requests(), 8);
  }
}

TEST(MemoryPlanTest, LittleMemoryReducesHeldBytesBeforeCallsAndRequests) {
  const v1::ServerConfig options = OptionsFor(400 * kMebibyte);
  EXPECT_EQ(options.max_calls(), 128);
  EXPECT_EQ(options.max_request_bytes(), 32 * kMebibyte);
  EXPECT_EQ(options.max_transport_bytes(), 96 * kMebibyte);
  EXPECT_EQ(options.max_slow_requests(), 1);
  EXPECT_LT(options.max_held_bytes(), 128 * kMebibyte);
  EXPECT_GE(options.max_held_bytes(), 52000000u) << "two leaders of ten minutes at 240 Hz";
}

TEST(MemoryPlanTest, MoreMemoryNeverMeansLowerLimits) {
  v1::ServerConfig before = OptionsFor(64 * kMebibyte);
  for (std::uint64_t memory = 72; memory < 3000; memory += 8) {
    const v1::ServerConfig now = OptionsFor(memory * kMebibyte);
    EXPECT_GE(now.max_calls(), before.max_calls()) << memory;
    EXPECT_GE(now.max_request_bytes(), before.max_request_bytes()) << memory;
    EXPECT_GE(NeedOf(now).total(), NeedOf(before).total()) << memory;
    before = now;
  }
}

TEST(MemoryPlanTest, TooLittleMemoryGetsTheSmallestLimitsAndAWarning) {
  const v1::ServerConfig options = OptionsFor(64 * kMebibyte);
  EXPECT_EQ(options.max_calls(), 4);
  EXPECT_EQ(options.max_request_bytes(), kMebibyte);
  EXPECT_EQ(options.max_transport_bytes(), 3 * kMebibyte);
  EXPECT_EQ(options.max_held_bytes(), kMebibyte);
  EXPECT_THAT(MemoryWarnings(options, 64 * kMebibyte),
              ElementsAre(AllOf(HasSubstr("the limit is 67 MB"), HasSubstr("max_calls = 4"))));
}

TEST(MemoryPlanTest, ExplicitSettingIsKeptAndOthersShrink) {
  v1::ServerConfig config;
  config.set_max_held_bytes(300 * kMebibyte);
  const v1::ServerConfig options = OptionsFor(800 * kMebibyte, config);
  EXPECT_EQ(options.max_held_bytes(), 300 * kMebibyte);
  EXPECT_THAT(MemoryWarnings(options, 800 * kMebibyte), IsEmpty());
  config.set_max_calls(7);
  config.set_max_request_bytes(5 * kMebibyte);
  config.set_max_transport_bytes(11 * kMebibyte);
  const v1::ServerConfig all = OptionsFor(400 * kMebibyte, config);
  EXPECT_EQ(all.max_calls(), 7);
  EXPECT_EQ(all.max_request_bytes(), 5 * kMebibyte);
  EXPECT_EQ(all.max_transport_bytes(), 11 * kMebibyte);
  EXPECT_EQ(all.max_held_bytes(), 300 * kMebibyte);
}

TEST(MemoryPlanTest, WarnsAboutExplicitSettingsThatDoNotFit) {
  v1::ServerConfig config;
  config.set_max_held_bytes(512 * kMebibyte);
  config.set_max_transport_bytes(512 * kMebibyte);
  const v1::ServerConfig options = OptionsFor(400 * kMebibyte, config);
  EXPECT_EQ(options.max_held_bytes(), 512 * kMebibyte);
  EXPECT_THAT(
      MemoryWarnings(options, 400 * kMebibyte),
      ElementsAre(AllOf(HasSubstr("the limit is 419 MB"), HasSubstr("536 MB for max_held_bytes"),
                        HasSubstr("536 MB for max_transport_bytes"))));
}

TEST(MemoryPlanTest, WarnsAboutALimitAboveTheMachinesMemory) {
  v1::ServerConfig config;
  config.set_memory_limit_bytes(4000 * kMebibyte);
  const v1::ServerConfig options = OptionsFor(400 * kMebibyte, config);
  EXPECT_THAT(
      MemoryWarnings(options, 400 * kMebibyte),
      ElementsAre(AllOf(HasSubstr("got 4194304000"), HasSubstr("expected at most 419430400")),
                  HasSubstr("the limit is 419 MB")));
}

TEST(MemoryPlanTest, RefusesALimitThatNoServerFitsInto) {
  v1::ServerConfig config;
  config.set_memory_limit_bytes(1000);
  EXPECT_THAT(
      ResolveSettings(config, 2),
      StatusIs(
          absl::StatusCode::kInvalidArgument,
          HasSubstr("memory_limit_bytes: expected 67108864 to 18446744073709551615, got 1000")));
}

}  // namespace
}  // namespace duet::server::config
