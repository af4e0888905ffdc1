// How calls end other than well: refusals over the wire, deadlines, cancellation, failures.

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::AddWeight;
using test::Call;
using test::Decode;
using test::FakeDescription;
using test::FakeSynthesizer;
using test::PuppetScheduler;
using test::RawCall;
using test::ReadAll;
using test::Refusal;
using test::Reply;
using test::RunningService;
using test::SampleRequest;
using test::TimedContext;

using absl::StatusCode;

// A service whose windows the test evaluates.
struct PuppetService {
  explicit PuppetService(RunningService::Setup setup = RunningService::Setup())
      : running((setup.scheduler = &puppet, setup)) {}
  PuppetScheduler puppet;
  RunningService running;
};

std::string Trailer(const grpc::ClientContext& context, const std::string& key) {
  const auto& trailers = context.GetServerTrailingMetadata();
  const auto found = trailers.find(key);
  return found == trailers.end() ? "" : std::string(found->second.data(), found->second.size());
}

TEST(ServiceRefusalTest, LargestRejectionReachesTheClient) {
  RunningService running;
  v1::SynthesizeRequest request;
  for (int i = 0; i < 1000; ++i) {
    AddWeight(*request.add_label_keyframes()->mutable_label_vector(), std::string(200, 'x'), 9);
    request.add_reply_joint_names(std::string(200, '\n'));
    request.mutable_leader()->add_joint_names(std::string(200, 'y'));
  }
  const Refusal refusal = Decode(Call(running.stub(), request).status);
  // Trailers above the client's limit would turn into RESOURCE_EXHAUSTED.
  EXPECT_EQ(refusal.code, StatusCode::kInvalidArgument);
  EXPECT_GT(refusal.violations.size(), 5u);
}

TEST(ServiceRefusalTest, EveryMethodBoundsAndChecksItsMessage) {
  RunningService::Setup setup;
  setup.limits.max_request_bytes = 8192;
  RunningService running(setup);
  const std::string groups = "\xfb\x06\xfc\x06\xfb\x06\xfc\x06\xfb\x06\xfc\x06";
  const std::string large = std::string("\xfa\x06\xa8\x46", 4) + std::string(9000, 'x');
  const std::tuple<std::string, const char*, StatusCode> cases[] = {
      {groups, "INVALID_REQUEST", StatusCode::kInvalidArgument},
      {large, "REQUEST_TOO_LARGE", StatusCode::kResourceExhausted},
      {"\x0a\x04\x0a\x02\xff\xfe", "INVALID_REQUEST", StatusCode::kInvalidArgument},  // UTF-8
      {"\x0a\x7f", "INVALID_REQUEST", StatusCode::kInvalidArgument}};  // runs past the end
  for (const std::string method : {"Synthesize", "GetModel", "ListModels"}) {
    const std::string path = "/duet.v1.MotionSynthesis/" + method;
    for (const auto& [bytes, reason, code] : cases) {
      // A request to list models has no field that could be malformed.
      if (method == "ListModels" && bytes.size() < 10) continue;
      RawCall call(running.channel(), path, bytes);
      EXPECT_FALSE(call.Read().has_value()) << method;
      const Refusal refusal = Decode(call.Finish());
      EXPECT_EQ(refusal.reason, reason) << method;
      EXPECT_EQ(refusal.code, code) << method;
      if (bytes.size() < 10) {
        EXPECT_THAT(refusal.Of("duet.v1." + method + "Request"),
                    HasSubstr("bytes that do not parse"));
      }
    }
    RawCall without_message(running.channel(), path);
    without_message.SendNoMore();
    EXPECT_EQ(Decode(without_message.Finish()).code, StatusCode::kInvalidArgument) << method;
  }
}

TEST(ServiceRefusalTest, RejectionOfALargeRequestNamesTheLimit) {
  RunningService::Setup setup;
  setup.limits.max_request_bytes = 8192;  // 40 frames are 7 kB
  RunningService running(setup);
  EXPECT_TRUE(Call(running.stub(), SampleRequest(40)).status.ok());
  const v1::SynthesizeRequest request = SampleRequest(80);
  const Refusal refusal = Decode(Call(running.stub(), request).status);
  EXPECT_EQ(refusal.reason, "REQUEST_TOO_LARGE");
  EXPECT_EQ(refusal.metadata.at("max_request_bytes"), "8192");
  EXPECT_EQ(refusal.metadata.at("request_bytes"), std::to_string(request.ByteSizeLong()));
  EXPECT_THAT(refusal.message, HasSubstr("max_request_bytes = 8192"));
  EXPECT_LT(refusal.retry_seconds, 0) << "the same request will not fit later either";
}

TEST(ServiceRefusalTest, FullQueueRejectsBeforeTheHeader) {
  PuppetService service;
  service.puppet.Refuse(absl::ResourceExhaustedError("the queue is full: 64 windows wait"));
  TimedContext context;
  const Reply reply = Call(service.running.stub(), SampleRequest(), context);
  EXPECT_THAT(reply.messages, IsEmpty());
  const Refusal refusal = Decode(reply.status);
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_EQ(refusal.reason, "QUEUE_FULL");
  EXPECT_EQ(refusal.retry_seconds, 1);
  EXPECT_EQ(Trailer(context, "grpc-retry-pushback-ms"), "1000");
  EXPECT_EQ(service.running.admission().calls(), 0u) << "the place is free again";
}

TEST(ServiceRefusalTest, EveryMethodOfAServerThatDoesNotServeIsUnavailableWithARetryDelay) {
  RunningService running;
  for (const auto& [state, reason] : {std::pair{Admission::State::kLoading, "SERVER_LOADING"},
                                      {Admission::State::kDraining, "SERVER_DRAINING"}}) {
    running.admission().SetState(state);
    TimedContext list_context, get_context;
    v1::ListModelsResponse list;
    v1::GetModelResponse model;
    for (const grpc::Status& status :
         {Call(running.stub(), SampleRequest()).status,
          running.stub().ListModels(&list_context, v1::ListModelsRequest(), &list),
          running.stub().GetModel(&get_context, v1::GetModelRequest(), &model)}) {
      const Refusal refusal = Decode(status);
      EXPECT_EQ(refusal.code, StatusCode::kUnavailable);
      EXPECT_EQ(refusal.reason, reason);
      EXPECT_EQ(refusal.retry_seconds, 1);
    }
  }
}

TEST(ServiceEndTest, ModelFailureIsInternalWithDetailsOnlyInTheLog) {
  auto model = std::make_shared<FakeSynthesizer>();
  model->window_status = [](const engine::SynthesisWindow&) {
    return absl::InternalError("at::addmm in /usr/secret/generator.cc failed");
  };
  RunningService::Setup setup;
  setup.model = model;
  RunningService running(setup);
  const Refusal refusal = Decode(Call(running.stub(), SampleRequest()).status);
  EXPECT_EQ(refusal.code, StatusCode::kInternal);
  EXPECT_EQ(refusal.reason, "MODEL_FAILED");
  EXPECT_THAT(refusal.message, Not(HasSubstr("addmm")));
  EXPECT_THAT(refusal.message, Not(HasSubstr("/usr")));
  const metrics::CallRecord record = running.calls().WaitFor(1);
  EXPECT_THAT(record.cause, HasSubstr("at::addmm in /usr/secret/generator.cc"));
  EXPECT_THAT(refusal.message, HasSubstr(record.request_id));
}

TEST(ServiceEndTest, AWindowDroppedByTheSchedulerEndsTheCall) {
  PuppetService service;
  TimedContext context;
  const auto reader = service.running.stub().Synthesize(&context, SampleRequest());
  service.puppet.FailNext(absl::UnavailableError("the server is shutting down"));
  const Refusal refusal = Decode(ReadAll(*reader).status);
  EXPECT_EQ(refusal.code, StatusCode::kUnavailable);
  EXPECT_EQ(refusal.reason, "SERVER_DRAINING");
}

TEST(ServiceRecordTest, SaysWhoCalledAndWhatTheCallDid) {
  RunningService::Setup setup;
  setup.client_key = "x-client";
  PuppetService service(setup);
  const std::string trace = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
  TimedContext context;
  context.AddMetadata("x-request-id", "shot-42/take.3");
  context.AddMetadata("traceparent", trace);
  context.AddMetadata("x-client", "studio");
  v1::SynthesizeRequest request = SampleRequest(46);
  request.set_priority(v1::PRIORITY_BULK);
  const auto reader = service.running.stub().Synthesize(&context, request);
  service.puppet.WaitForJobs(1);
  EXPECT_EQ(service.puppet.Oldest().priority, batching::Priority::kBulk);
  EXPECT_EQ(service.puppet.Oldest().client, "studio");
  service.puppet.RunNext();
  const Reply reply = ReadAll(*reader);
  ASSERT_TRUE(reply.status.ok());
  EXPECT_EQ(reply.messages.front().header().request_id(), "shot-42/take.3");
  const metrics::CallRecord record = service.running.calls().WaitFor(1);
  EXPECT_TRUE(record.status.ok());
  EXPECT_EQ(record.request_id, "shot-42/take.3");
  EXPECT_EQ(record.traceparent, trace);
  EXPECT_THAT(record.peer, HasSubstr("127.0.0.1"));
  EXPECT_EQ(record.method.name, "Synthesize");
  EXPECT_EQ(record.model, "fake");
  EXPECT_EQ(record.version, 1);
  EXPECT_EQ(record.priority, "bulk");
  EXPECT_EQ(record.frames, 46);
  EXPECT_EQ(record.chunks, 2);
  EXPECT_EQ(record.totals.windows, 1);
  EXPECT_DOUBLE_EQ(record.totals.queue_seconds, 0.25);
  EXPECT_DOUBLE_EQ(record.totals.compute_seconds, 0.5);
  EXPECT_GE(record.first_chunk_seconds, 0);
  EXPECT_GE(record.total_seconds, record.first_chunk_seconds);
}

TEST(ServiceRecordTest, ReplacesAnInvalidRequestId) {
  RunningService running;
  TimedContext context;
  context.AddMetadata("x-request-id", std::string(129, 'x'));
  const Reply reply = Call(running.stub(), SampleRequest(), context);
  ASSERT_TRUE(reply.status.ok());
  EXPECT_EQ(reply.messages.front().header().request_id().size(), 32u);
}

TEST(ModelMethodsTest, DescribesAModelAndItsLimits) {
  RunningService running;
  TimedContext context;
  v1::GetModelResponse response;
  ASSERT_TRUE(running.stub().GetModel(&context, v1::GetModelRequest(), &response).ok());
  const engine::ModelDescription fake = FakeDescription();
  EXPECT_EQ(response.model().name(), "fake");
  EXPECT_THAT(response.model().interaction_classes(), ElementsAreArray(fake.classes));
  EXPECT_THAT(response.model().joint_names(), ElementsAreArray(fake.skeleton.joint_names));
  EXPECT_EQ(response.model().bones_size(), 14);
  EXPECT_EQ(response.model().root_joint(), "torso");
  EXPECT_EQ(response.model().frame_rate_hz(), 15);
  EXPECT_EQ(response.model().window_frames(), 46u);
  EXPECT_TRUE(response.model().accepts_follower_start());
  EXPECT_FALSE(response.model().samples());
  EXPECT_EQ(response.model().description(), fake.description);
  v1::RequestLimits limits;
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(
      R"(min_frame_rate_hz: 1 max_frame_rate_hz: 240 min_frames: 2 max_duration_seconds: 600
         max_chunk_frames: 240 max_label_keyframes: 4096 max_abs_weight: 2 max_variety: 2
         max_candidates: 16 max_request_bytes: 33554432 max_delay_frames: 10 max_plan_frames: 30
         max_constraints: 64)",
      &limits));
  EXPECT_EQ(response.limits().DebugString(), limits.DebugString());
}

}  // namespace
}  // namespace duet::server::service
