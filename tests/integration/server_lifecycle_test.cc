// The whole server in one process: loading, health, reflection, metrics, draining.

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/lifecycle/duet_server.h"
#include "tests/integration/running_server.h"
#include "tests/server/support/fakes.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"

namespace duet::test {
namespace {

using absl::StatusCode;
using nlohmann::json;

TEST(LoadingTest, TheServerListensAndSaysThatItIsNotReady) {
  Running server;
  EXPECT_EQ(Health(server.channel, ""), "NOT_SERVING");
  EXPECT_EQ(Health(server.channel, "duet.v1.MotionSynthesis"), "NOT_SERVING");
  EXPECT_THAT(HttpGet(server->metrics_port(), "/readyz"), StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(HttpGet(server->metrics_port(), "/healthz"), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(Decode(server.List()).reason, "SERVER_LOADING");
}

TEST(LoadingTest, ServesOnceItsModelsAreThere) {
  Running server;
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  EXPECT_EQ(Health(server.channel, ""), "SERVING");
  EXPECT_EQ(Health(server.channel, "duet.v1.MotionSynthesis"), "SERVING");
  EXPECT_EQ(Health(server.channel, "duet.v1.MotionSynthesis/fake"), "SERVING");
  EXPECT_EQ(Health(server.channel, "duet.v1.MotionSynthesis/other"), "service name unknown");
  EXPECT_THAT(HttpGet(server->metrics_port(), "/readyz"), StartsWith("HTTP/1.1 200"));
  EXPECT_TRUE(Call(*server.stub, SampleRequest()).status.ok());
  const std::vector<json> serving = server.log.Events("serving");
  ASSERT_EQ(serving.size(), 1u);
  EXPECT_EQ(serving[0]["port"], server->port());
  EXPECT_EQ(serving[0]["metrics_port"], server->metrics_port());
}

TEST(LoadingTest, RefusesToServeNothing) {
  Running server;
  EXPECT_THAT(server->Serve(),
              StatusIs(StatusCode::kFailedPrecondition, HasSubstr("no model could be loaded")));
  EXPECT_EQ(Health(server.channel, ""), "NOT_SERVING");
}

// What a server says of itself while its self-check fails, and when it succeeds again.
TEST(ReadinessTest, AFailedSelfCheckTurnsReadinessAndHealthUntilOneSucceeds) {
  std::atomic<bool> well{true};
  v1::ServerConfig options = TestOptions();
  options.set_self_check_seconds(0.001);
  Running server(options, [&well] {
    return well ? absl::OkStatus() : absl::UnavailableError("nobody answers");
  });
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  const std::vector<std::string> names = {"", "duet.v1.MotionSynthesis",
                                          "duet.v1.MotionSynthesis/fake"};
  const auto wait_for_health = [&](const std::string& wanted) {
    for (const std::string& name : names) {
      while (Health(server.channel, name) != wanted) std::this_thread::yield();
    }
  };
  const auto page = [&server](const char* path) { return HttpGet(server->metrics_port(), path); };
  wait_for_health("SERVING");
  well = false;
  wait_for_health("NOT_SERVING");
  EXPECT_THAT(page("/readyz"), StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(page("/metrics"), AllOf(HasSubstr("duet_ready 0\n"),
                                      Not(HasSubstr("duet_self_check_failures_total 0\n"))));
  EXPECT_THAT(server.log.Events("self_check_failed")[0]["message"].get<std::string>(),
              HasSubstr("nobody answers"));
  EXPECT_TRUE(Call(*server.stub, SampleRequest()).status.ok())
      << "who still gets through is served";
  while (!absl::StartsWith(page("/healthz"), "HTTP/1.1 503")) std::this_thread::yield();
  well = true;
  wait_for_health("SERVING");
  EXPECT_THAT(page("/readyz"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page("/healthz"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page("/metrics"), HasSubstr("duet_ready 1\n"));
  EXPECT_EQ(server.log.Events("self_check_recovered").size(), 1u);
}

TEST(ReadinessTest, ASelfCheckThatSucceedsDoesNotEndADrain) {
  std::atomic<int> checks{0};
  std::atomic<bool> well{false};
  v1::ServerConfig options = TestOptions();
  options.set_self_check_seconds(0.001);
  options.set_drain_seconds(7);
  Running server(options, [&] {
    ++checks;
    return well ? absl::OkStatus() : absl::UnavailableError("nobody answers");
  });
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  server->Drain([&](double) {
    well = true;
    const int before = checks;
    while (checks < before + 3) std::this_thread::yield();
    EXPECT_EQ(Health(server.channel, ""), "NOT_SERVING");
    EXPECT_THAT(HttpGet(server->metrics_port(), "/readyz"), StartsWith("HTTP/1.1 503"));
    return true;
  });
}

TEST(ListenTest, ASecondServerOnAPortFailsAndSaysWhere) {
  Running first;
  EventSink log;
  const auto expect_fails = [&](const v1::ServerConfig& options, const std::string& address) {
    EXPECT_THAT(server::lifecycle::DuetServer::Start(options, log),
                StatusIs(StatusCode::kUnavailable, HasSubstr(address)));
  };
  const std::string grpc = absl::StrCat("127.0.0.1:", first->port());
  const std::string http = absl::StrCat("127.0.0.1:", first->metrics_port());
  v1::ServerConfig options = TestOptions();
  options.set_admin_listen(grpc);
  expect_fails(options, grpc);
  options = TestOptions();
  options.set_listen(grpc);
  expect_fails(options, grpc);
  options = TestOptions();
  options.set_metrics_listen(http);
  expect_fails(options, http);
}

// ServerReflectionRequest{list_services = 7: ""}.
const std::string kListServices = std::string("\x3a\x00", 2);
constexpr char kReflection[] = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

TEST(ReflectionTest, NamesTheServicesUnlessItIsOff) {
  v1::ServerConfig options = TestOptions();
  Running server(options);
  RawCall call(server.channel, kReflection, kListServices);
  EXPECT_THAT(call.Read().value_or(""),
              AllOf(HasSubstr("duet.v1.MotionSynthesis"), HasSubstr("grpc.health.v1.Health")));
  options.set_reflection(false);
  Running without(options);
  RawCall refused(without.channel, kReflection, kListServices);
  EXPECT_FALSE(refused.Read().has_value());
  EXPECT_EQ(refused.Finish().error_code(), grpc::StatusCode::UNIMPLEMENTED);
}

TEST(ReportTest, ACallIsInMetricsAndLogWhenItsCallerKnows) {
  Running server;
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  ASSERT_TRUE(Call(*server.stub, SampleRequest(40)).status.ok());
  const std::string metrics = HttpGet(server->metrics_port(), "/metrics");
  EXPECT_THAT(metrics, HasSubstr(R"(grpc_server_handled_total{grpc_code="OK")"));
  EXPECT_THAT(metrics, HasSubstr(R"(duet_frames_total{model="fake",version="1"} 40)"));
  EXPECT_THAT(metrics, HasSubstr("duet_compute_seconds_count 1"));
  EXPECT_THAT(metrics, HasSubstr(R"(duet_calls_in_flight{method="Synthesize"} 0)"));
  const std::vector<json> calls = server.log.Events("call");
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0]["frames"], 40);
  EXPECT_EQ(calls[0]["code"], "OK");
}

TEST(DrainTest, ServesOnForDrainSecondsWhileHealthSaysNo) {
  v1::ServerConfig options = TestOptions();
  options.set_drain_seconds(7);
  Running server(options);
  server.Load();
  ASSERT_THAT(server->Serve(), IsOk());
  std::vector<double> waits;
  server->Drain([&](double seconds) {
    waits.push_back(seconds);
    EXPECT_EQ(Health(server.channel, ""), "NOT_SERVING");
    EXPECT_EQ(Health(server.channel, "duet.v1.MotionSynthesis/fake"), "NOT_SERVING");
    EXPECT_THAT(HttpGet(server->metrics_port(), "/readyz"), StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(HttpGet(server->metrics_port(), "/healthz"), StartsWith("HTTP/1.1 200"));
    EXPECT_TRUE(Call(*server.stub, SampleRequest()).status.ok());
    return true;
  });
  EXPECT_THAT(waits, ElementsAre(7));
}

TEST(DrainTest, ACallUnderWayFinishesAndNewOnesAreSentElsewhere) {
  GatedModel model;
  Running server;
  server.Load(model.get());
  ASSERT_THAT(server->Serve(), IsOk());
  Reply reply;
  std::thread caller([&] { reply = Call(*server.stub, SampleRequest(200)); });
  model.WaitUntilStarted(1);
  bool first = true;
  server->Drain([&](double) {
    if (!std::exchange(first, false)) return true;
    const Refusal refusal = Decode(Call(*server.stub, SampleRequest()).status);
    EXPECT_EQ(refusal.code, StatusCode::kUnavailable);
    EXPECT_EQ(refusal.reason, "SERVER_DRAINING");
    EXPECT_EQ(refusal.retry_seconds, 1);
    model.Open();
    caller.join();
    return true;
  });
  EXPECT_FALSE(first) << "the drain did not wait for the call";
  EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_TRUE(reply.messages.back().has_summary());
}

TEST(DrainTest, ACallThatOutlivesTheGraceEndsAsUnavailable) {
  GatedModel model;
  v1::ServerConfig options = TestOptions();
  options.set_drain_seconds(0);
  options.set_grace_seconds(0.2);
  Running server(options);
  server.Load(model.get());
  ASSERT_THAT(server->Serve(), IsOk());
  Reply reply;
  std::thread caller([&] { reply = Call(*server.stub, SampleRequest(200)); });
  model.WaitUntilStarted(1);
  double waited = 0;
  server->Drain([&](double seconds) {
    waited += seconds;
    return true;
  });
  caller.join();
  EXPECT_NEAR(waited, 0.2, 1e-9);
  EXPECT_EQ(Decode(reply.status).code, StatusCode::kUnavailable);
  EXPECT_EQ(Decode(reply.status).reason, "SERVER_DRAINING");
  EXPECT_EQ(server.log.Events("stopped")[0]["aborted_calls"], 1);
  model.Open();
}

}  // namespace
}  // namespace duet::test
