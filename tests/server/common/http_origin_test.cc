#include "server/common/http_origin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"

namespace duet::server::common {
namespace {

TEST(HttpOriginTest, ParsesSchemeHostAndPort) {
  for (const char* good : {"http://localhost:4317", "http://10.0.0.1:1", "http://my_collector:4317",
                           "http://[::1]:65535", "http://otel-collector.example:4317"}) {
    const absl::StatusOr<HttpOrigin> origin = ParseHttpOrigin(good);
    ASSERT_THAT(origin, IsOk()) << good;
    EXPECT_FALSE(origin->encrypted);
    EXPECT_EQ("http://" + origin->authority, good);
  }
  const absl::StatusOr<HttpOrigin> encrypted = ParseHttpOrigin("https://a.example:4317");
  ASSERT_THAT(encrypted, IsOk());
  EXPECT_TRUE(encrypted->encrypted);
  EXPECT_EQ(encrypted->authority, "a.example:4317");
}

TEST(HttpOriginTest, RejectsAnythingElse) {
  for (const char* bad : {"", "a:1", "ftp://a:1", "grpc://a:1", "http://", "http://a", "http://:1",
                          "http://a:", "http://a:0", "http://a:65536", "http://a:+1",
                          "http://a:1/v1/traces", "http://a:1?x", "http://user@a:1", "http://a b:1",
                          "http://::1:4317", "http://[]:1", "HTTP://a:1"}) {
    EXPECT_THAT(
        ParseHttpOrigin(bad),
        StatusIs(absl::StatusCode::kInvalidArgument,
                 testing::StartsWith("expected http://HOST:PORT or https://HOST:PORT, got \"")))
        << bad;
  }
}

}  // namespace
}  // namespace duet::server::common
