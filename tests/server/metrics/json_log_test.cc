#include "server/metrics/json_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace duet::server::metrics {
namespace {

using nlohmann::json;

class VectorSink final : public LogSink {
 public:
  bool Write(std::string_view line) override {
    lines.emplace_back(line);
    return true;
  }
  json Last() const { return json::parse(lines.back()); }
  std::vector<std::string> lines;
};

CallRecord Record() {
  CallRecord record;
  record.method = {"duet.v1.MotionSynthesis", "Synthesize", "server_stream"};
  record.request_id = "id-1";
  record.peer = "ipv4:10.0.0.1:4711";
  record.model = "sbu";
  record.version = 3;
  record.priority = "bulk";
  record.seed = 18446744073709551615u;
  record.variety = 0.5;
  record.candidates = 4;
  record.clean_up = true;
  record.unfamiliarity = 1.25;
  record.frames = 300;
  record.chunks = 10;
  record.totals.windows = 7;
  record.first_chunk_seconds = 0.25;
  record.totals.queue_seconds = 0.5;
  record.totals.compute_seconds = 1.5;
  record.total_seconds = 2;
  return record;
}

class JsonLogTest : public ::testing::Test {
 protected:
  VectorSink sink_;
  JsonLog log_{sink_, [] { return absl::FromUnixMicros(1650000000123456); }};
};

TEST_F(JsonLogTest, WritesACallAsOneLineOfJson) {
  CallRecord record = Record();
  record.caller = "studio";
  record.traceparent = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
  log_.CallFinished(record);
  ASSERT_EQ(sink_.lines.size(), 1u);
  EXPECT_EQ(sink_.lines[0].find('\n'), std::string::npos);
  EXPECT_EQ(sink_.Last(), json::parse(R"({
    "time": "2022-04-15T05:20:00.123456Z", "severity": "INFO", "event": "call",
    "method": "Synthesize", "request_id": "id-1", "peer": "ipv4:10.0.0.1:4711",
    "traceparent": "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
    "trace_id": "4bf92f3577b34da6a3ce929d0e0e4736", "caller": "studio", "code": "OK",
    "model": "sbu", "version": 3, "priority": "bulk", "seed": 18446744073709551615,
    "variety": 0.5, "candidates": 4, "clean_up": true, "unfamiliarity": 1.25, "frames": 300,
    "chunks": 10, "windows": 7, "peak_buffered_frames": 0, "first_chunk_seconds": 0.25,
    "queue_seconds": 0.5, "compute_seconds": 1.5, "total_seconds": 2.0})"));
}

TEST_F(JsonLogTest, OmitsFieldsThatACallDoesNotHave) {
  CallRecord record;
  record.method = {"duet.v1.MotionSynthesis", "ListModels", "unary"};
  log_.CallFinished(record);
  std::vector<std::string> fields;
  for (const auto& [field, value] : sink_.Last().items()) fields.push_back(field);
  EXPECT_THAT(fields, ElementsAre("code", "event", "method", "peer", "request_id", "severity",
                                  "time", "total_seconds"));
}

TEST_F(JsonLogTest, InvalidUtf8BecomesAValidLine) {
  CallRecord record = Record();
  record.status = absl::InvalidArgumentError("a\nb\"c\xff\xfe");
  log_.CallFinished(record);
  EXPECT_EQ(sink_.lines[0].find('\n'), std::string::npos);
  EXPECT_FALSE(json::parse(sink_.lines[0])["message"].get<std::string>().empty());
}

TEST_F(JsonLogTest, EventsCarryTheirFields) {
  log_.Error("model_refused", {{"source", "sbu/3"}});
  EXPECT_EQ(sink_.Last()["severity"], "ERROR");
  EXPECT_EQ(sink_.Last()["event"], "model_refused");
  EXPECT_EQ(sink_.Last()["source"], "sbu/3");
}

TEST_F(JsonLogTest, OmitsLinesBelowTheLevel) {
  JsonLog log(sink_, absl::Now, {Severity::kWarning, 10});
  log.Info("serving", {});
  log.CallFinished(Record());
  EXPECT_TRUE(sink_.lines.empty());
  CallRecord refused = Record();
  refused.status = absl::ResourceExhaustedError("full");
  log.CallFinished(refused);
  log.Error("model_refused", {});
  EXPECT_EQ(sink_.lines.size(), 2u);
}

TEST_F(JsonLogTest, ReportsUnloggedRejectionsInOneLine) {
  CallRecord refused = Record();
  refused.status = absl::ResourceExhaustedError("full");
  {
    JsonLog log(sink_, [] { return absl::FromUnixSeconds(5); }, {Severity::kInfo, 2});
    for (int i = 0; i < 100; ++i) log.CallFinished(refused);
    EXPECT_EQ(sink_.lines.size(), 2u);
    log.TellUnlogged();
    ASSERT_EQ(sink_.lines.size(), 3u);
    EXPECT_EQ(sink_.Last()["event"], "calls_not_logged");
    EXPECT_EQ(sink_.Last()["severity"], "WARNING");
    EXPECT_EQ(sink_.Last()["code"], "RESOURCE_EXHAUSTED");
    EXPECT_EQ(sink_.Last()["calls"], 98);
    log.TellUnlogged();
    EXPECT_EQ(sink_.lines.size(), 3u);
    log.CallFinished(refused);
  }
  // The destructor reports the rest.
  ASSERT_EQ(sink_.lines.size(), 4u);
  EXPECT_EQ(sink_.Last()["calls"], 1);
}

TEST_F(JsonLogTest, AlwaysLogsFailuresOfTheServerWithTheirCause) {
  JsonLog log(sink_, absl::Now, {Severity::kError, 0});
  CallRecord failed = Record();
  failed.status = absl::InternalError("the model failed");
  failed.cause = "INTERNAL: shapes differ";
  for (int i = 0; i < 20; ++i) log.CallFinished(failed);
  EXPECT_EQ(sink_.lines.size(), 20u);
  EXPECT_EQ(sink_.Last()["severity"], "ERROR");
  EXPECT_EQ(sink_.Last()["cause"], "INTERNAL: shapes differ");
}

TEST_F(JsonLogTest, LimitsMessagesOfLibraries) {
  {
    JsonLog log(sink_, [] { return absl::FromUnixSeconds(5); }, {Severity::kInfo, 2});
    for (int i = 0; i < 50; ++i) log.Library("grpc", Severity::kError, "handshake failed");
    ASSERT_EQ(sink_.lines.size(), 2u);
    EXPECT_EQ(sink_.Last()["event"], "library");
    EXPECT_EQ(sink_.Last()["severity"], "ERROR");
    EXPECT_EQ(sink_.Last()["library"], "grpc");
    EXPECT_EQ(sink_.Last()["message"], "handshake failed");
  }
  ASSERT_EQ(sink_.lines.size(), 3u);
  EXPECT_EQ(sink_.Last()["event"], "library_lines_not_logged");
  EXPECT_EQ(sink_.Last()["lines"], 48);
}

TEST_F(JsonLogTest, AlwaysLogsActionsOfAdministrators) {
  JsonLog log(sink_, absl::Now, {Severity::kError, 0});
  CallRecord call = Record();
  call.method.name = "LoadModel";
  call.caller = "ops";
  log.Audit(call, absl::OkStatus(), {{"model", "sbu"}});
  json line = sink_.Last();
  line.erase("time");
  EXPECT_EQ(line, json::parse(R"({"severity": "INFO", "event": "admin_action", "caller": "ops",
                                  "peer": "ipv4:10.0.0.1:4711", "request_id": "id-1",
                                  "action": "LoadModel", "arguments": {"model": "sbu"},
                                  "code": "OK"})"));
  log.Audit(call, absl::NotFoundError("no such model"), {});
  EXPECT_EQ(sink_.Last()["code"], "NOT_FOUND");
  EXPECT_EQ(sink_.Last()["message"], "no such model");
}

}  // namespace
}  // namespace duet::server::metrics
