#include "server/tracing/call_tracer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace duet::server::tracing {
namespace {

constexpr std::int64_t kEnd = 1'650'000'000'000'000'000;

metrics::CallRecord Record() {
  metrics::CallRecord record;
  record.method = {"duet.v1.MotionSynthesis", "Synthesize", "server_stream"};
  record.request_id = "id-1";
  record.trace = {"4bf92f3577b34da6a3ce929d0e0e4736", "00f067aa0ba902b7", "", true};
  record.model = "sbu";
  record.version = 3;
  record.priority = "bulk";
  record.frames = 300;
  record.windows = 7;
  record.first_chunk_seconds = 0.5;
  record.total_seconds = 2;
  return record;
}

Span Convert(const metrics::CallRecord& record) {
  return ToSpan(record, absl::FromUnixNanos(kEnd));
}

TEST(ToSpanTest, HasTimesAttributesAndTrace) {
  const Span span = Convert(Record());
  EXPECT_EQ(span.name, "duet.v1.MotionSynthesis/Synthesize");
  EXPECT_EQ(span.trace.span_id, "00f067aa0ba902b7");
  EXPECT_EQ(span.end, kEnd);
  EXPECT_EQ(span.start, kEnd - 2'000'000'000);
  EXPECT_THAT(span.events, ElementsAre(Pair(kEnd - 1'500'000'000, "first_chunk")));
  EXPECT_FALSE(span.failed);
  const auto attribute = [&span](const std::string& key) {
    for (const auto& [name, value] : span.attributes) {
      if (name == key) return value;
    }
    return AttributeValue(std::string("absent"));
  };
  EXPECT_EQ(attribute("rpc.system"), AttributeValue(std::string("grpc")));
  EXPECT_EQ(attribute("rpc.grpc.status_code"), AttributeValue(std::int64_t{0}));
  EXPECT_EQ(attribute("duet.model"), AttributeValue(std::string("sbu")));
  EXPECT_EQ(attribute("duet.frames"), AttributeValue(std::int64_t{300}));
  EXPECT_EQ(attribute("duet.caller"), AttributeValue(std::string("absent")));
}

TEST(ToSpanTest, OnlyErrorsOfTheServerAreFailures) {
  metrics::CallRecord record = Record();
  record.status = absl::InvalidArgumentError("chunk_frames: is 0");
  EXPECT_FALSE(Convert(record).failed);
  record.status = absl::InternalError("the model failed");
  EXPECT_TRUE(Convert(record).failed);
  EXPECT_EQ(Convert(record).message, "the model failed");
}

TEST(CallTracerTest, SendsOnlySpansOfSampledTraces) {
  std::vector<Span> sent;
  {
    SpanQueue::Options queue;
    queue.send = [&sent](const std::vector<Span>& spans) {
      sent.insert(sent.end(), spans.begin(), spans.end());
      return true;
    };
    CallTracer tracer(queue);
    metrics::CallRecord record = Record();
    tracer.CallFinished(record);
    record.trace.sampled = false;
    tracer.CallFinished(record);
  }
  EXPECT_EQ(sent.size(), 1u);
}

TEST(CallTracerTest, RejectsAnInvalidEndpoint) {
  for (const char* good : {"http://localhost:4317", "https://collector.example:4317"}) {
    EXPECT_THAT(CallTracer::Open(good, "1"), IsOk()) << good;
  }
  for (const char* bad : {"localhost:4317", "grpc://localhost:4317", "http://", "http://a:1/v1"}) {
    EXPECT_THAT(CallTracer::Open(bad, "1"),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("otlp_endpoint: expected ")))
        << bad;
  }
}

}  // namespace
}  // namespace duet::server::tracing
