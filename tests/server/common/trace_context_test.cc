#include "server/common/trace_context.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace duet::server::common {
namespace {

// The example in the W3C recommendation.
const std::string kTrace = "4bf92f3577b34da6a3ce929d0e0e4736";
const std::string kParent = "00f067aa0ba902b7";
const std::string kTraceparent = "00-" + kTrace + "-" + kParent + "-01";

TEST(TraceContextTest, ContinuesTheCallersTraceWithANewSpan) {
  const auto context = ContinueTrace(kTraceparent);
  ASSERT_TRUE(context.has_value());
  EXPECT_EQ(context->trace_id, kTrace);
  EXPECT_EQ(context->parent_span_id, kParent);
  EXPECT_TRUE(context->sampled);
  EXPECT_EQ(context->span_id.size(), 16u);
  EXPECT_NE(context->span_id, kParent);
  EXPECT_NE(context->span_id, ContinueTrace(kTraceparent)->span_id);
  EXPECT_EQ(Traceparent(*context), "00-" + kTrace + "-" + context->span_id + "-01");
}

TEST(TraceContextTest, CallerDecidesOnSampling) {
  EXPECT_FALSE(ContinueTrace("00-" + kTrace + "-" + kParent + "-00")->sampled);
  EXPECT_FALSE(ContinueTrace("00-" + kTrace + "-" + kParent + "-02")->sampled);
  EXPECT_TRUE(ContinueTrace("00-" + kTrace + "-" + kParent + "-ff")->sampled);
}

TEST(TraceContextTest, IgnoresAMalformedTraceparent) {
  for (const std::string& malformed :
       {std::string(), kTraceparent + "0", kTraceparent.substr(1), "01" + kTraceparent.substr(2),
        "00-" + kTrace + "x" + kParent + "-01", "00-" + kTrace + "-" + kParent + "x01",
        "00-" + std::string(32, '0') + "-" + kParent + "-01",
        "00-" + kTrace + "-" + std::string(16, '0') + "-01",
        "00-" + std::string(32, 'A') + "-" + kParent + "-01",
        "00-" + kTrace + "-" + kParent + "-0g"}) {
    EXPECT_FALSE(ContinueTrace(malformed).has_value()) << malformed;
  }
}

TEST(TraceContextTest, EmptyTraceHasNoTraceparent) { EXPECT_EQ(Traceparent({}), ""); }

TEST(TraceContextTest, NewTracesHaveDifferentIdentifiers) {
  std::set<std::string> ids;
  for (int i = 0; i < 100; ++i) {
    const TraceContext context = BeginTrace(1);
    EXPECT_TRUE(context.sampled);
    EXPECT_TRUE(context.parent_span_id.empty());
    EXPECT_TRUE(ContinueTrace(Traceparent(context)).has_value());
    ids.insert(context.trace_id);
  }
  EXPECT_EQ(ids.size(), 100u);
}

TEST(TraceContextTest, SamplesTheGivenFraction) {
  int sampled = 0;
  for (int i = 0; i < 10000; ++i) {
    EXPECT_FALSE(BeginTrace(0).sampled);
    sampled += BeginTrace(0.25).sampled ? 1 : 0;
  }
  // Twelve standard deviations.
  EXPECT_GT(sampled, 2000);
  EXPECT_LT(sampled, 3000);
}

}  // namespace
}  // namespace duet::server::common
