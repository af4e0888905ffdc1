// How calls end other than well: refusals over the wire, deadlines, cancellation, failures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/server/support/timed_context.h"
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

class MalformedBytesTest : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(MalformedBytesTest, AreInvalidArgumentsWithAReason) {
  RunningService running;
  const auto& [method, message] = GetParam();
  // A model name that is not UTF-8, and a length that runs past the end.
  for (const std::string& bytes :
       {std::string("\x0a\x04\x0a\x02\xff\xfe"), std::string("\x0a\x7f")}) {
    RawCall call(running.channel(), "/duet.v1.MotionSynthesis/" + method, bytes);
    EXPECT_FALSE(call.Read().has_value());
    const Refusal refusal = Decode(call.Finish());
    EXPECT_EQ(refusal.code, StatusCode::kInvalidArgument);
    EXPECT_THAT(refusal.Of("duet.v1." + message), HasSubstr("bytes that do not parse"));
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, MalformedBytesTest,
                         ::testing::Values(std::pair{"Synthesize", "SynthesizeRequest"},
                                           std::pair{"GetModel", "GetModelRequest"}));

TEST(ServiceRefusalTest, UnknownModelErrorListsServedModels) {
  RunningService running;
  v1::SynthesizeRequest request = SampleRequest();
  request.mutable_model()->set_name("nobody");
  const Refusal refusal = Decode(Call(running.stub(), request).status);
  EXPECT_EQ(refusal.code, StatusCode::kNotFound);
  EXPECT_EQ(refusal.Of("model.name"), "expected a served model (fake), got \"nobody\"");
  EXPECT_EQ(refusal.reason, "MODEL_NOT_FOUND");
}

RunningService::Setup SmallRequests() {
  RunningService::Setup setup;
  setup.limits.max_request_bytes = 8192;  // 40 frames are 7 kB
  return setup;
}

TEST(ServiceRefusalTest, RejectionOfALargeRequestNamesTheLimit) {
  RunningService running(SmallRequests());
  EXPECT_TRUE(Call(running.stub(), SampleRequest(40)).status.ok());
  const v1::SynthesizeRequest request = SampleRequest(80);
  const Refusal refusal = Decode(Call(running.stub(), request).status);
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_EQ(refusal.reason, "REQUEST_TOO_LARGE");
  EXPECT_EQ(refusal.metadata.at("max_request_bytes"), "8192");
  EXPECT_EQ(refusal.metadata.at("request_bytes"), std::to_string(request.ByteSizeLong()));
  EXPECT_THAT(refusal.message, HasSubstr("max_request_bytes = 8192"));
  EXPECT_LT(refusal.retry_seconds, 0) << "the same request will not fit later either";
}

TEST(ServiceRefusalTest, EveryMethodHasTheLimit) {
  RunningService running(SmallRequests());
  // A field that the message does not know, of 9000 bytes.
  const std::string bytes = std::string("\xfa\x06\xa8\x46", 4) + std::string(9000, 'x');
  for (const char* method : {"Synthesize", "ListModels", "GetModel"}) {
    RawCall call(running.channel(), std::string("/duet.v1.MotionSynthesis/") + method, bytes);
    EXPECT_FALSE(call.Read().has_value()) << method;
    EXPECT_EQ(Decode(call.Finish()).reason, "REQUEST_TOO_LARGE") << method;
  }
}

TEST(ServiceRefusalTest, RejectsACompressedRequest) {
  RunningService running;
  TimedContext context;
  context.set_compression_algorithm(GRPC_COMPRESS_GZIP);
  const Reply reply = Call(running.stub(), SampleRequest(400), context);
  EXPECT_EQ(reply.status.error_code(), grpc::StatusCode::UNIMPLEMENTED);
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

TEST(ServiceRefusalTest, RejectedRequestReleasesItsPlace) {
  RunningService::Setup setup;
  setup.admission.max_calls = 1;
  RunningService running(setup);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(Call(running.stub(), v1::SynthesizeRequest()).status.error_code(),
              grpc::StatusCode::INVALID_ARGUMENT);
  }
  EXPECT_TRUE(Call(running.stub(), SampleRequest()).status.ok());
}

class NotServingTest : public ::testing::TestWithParam<std::pair<Admission::State, std::string>> {};

TEST_P(NotServingTest, EveryMethodIsUnavailableWithARetryDelay) {
  RunningService running;
  running.admission().SetState(GetParam().first);
  const auto expect_refused = [](const grpc::Status& status) {
    const Refusal refusal = Decode(status);
    EXPECT_EQ(refusal.code, StatusCode::kUnavailable);
    EXPECT_EQ(refusal.reason, GetParam().second);
    EXPECT_EQ(refusal.retry_seconds, 1);
  };
  expect_refused(Call(running.stub(), SampleRequest()).status);
  TimedContext list_context, get_context;
  v1::ListModelsResponse list;
  expect_refused(running.stub().ListModels(&list_context, v1::ListModelsRequest(), &list));
  v1::GetModelResponse model;
  expect_refused(running.stub().GetModel(&get_context, v1::GetModelRequest(), &model));
}

INSTANTIATE_TEST_SUITE_P(Both, NotServingTest,
                         ::testing::Values(std::pair{Admission::State::kLoading, "SERVER_LOADING"},
                                           std::pair{Admission::State::kDraining,
                                                     "SERVER_DRAINING"}));

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

// Whether a call's window was in line before its deadline of so many seconds passed, which then
// ended the call.
bool ExpiresInLine(int seconds) {
  PuppetService service;
  TimedContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(seconds));
  const auto reader = service.running.stub().Synthesize(&context, SampleRequest());
  v1::SynthesizeResponse header;
  if (!reader->Read(&header)) return false;
  EXPECT_LT(service.puppet.NextDeadline(), common::TimePoint::max());
  const Reply reply = ReadAll(*reader);
  EXPECT_EQ(reply.status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  // The client's reset may overtake the deadline on a busy machine.
  EXPECT_THAT(service.running.calls().WaitFor(1).status.code(),
              AnyOf(StatusCode::kDeadlineExceeded, StatusCode::kCancelled));
  EXPECT_FALSE(service.puppet.RunNext()) << "its window was evaluated";
  return true;
}

TEST(ServiceEndTest, AnExpiredCallNeverStarts) {
  // As long as a busy machine needs for it to come into line.
  int seconds = 1;
  while (!ExpiresInLine(seconds)) seconds *= 2;
}

TEST(ServiceEndTest, ACallCancelledMidwayStopsThere) {
  PuppetService service;
  TimedContext context;
  const auto reader = service.running.stub().Synthesize(&context, SampleRequest(900));
  service.puppet.RunNext();
  v1::SynthesizeResponse message;
  while (reader->Read(&message) && !message.has_chunk()) {
  }
  service.puppet.WaitForJobs(1);
  context.TryCancel();
  EXPECT_EQ(ReadAll(*reader).status.error_code(), grpc::StatusCode::CANCELLED);
  const metrics::CallRecord record = service.running.calls().WaitFor(1);
  EXPECT_EQ(record.status.code(), StatusCode::kCancelled);
  EXPECT_EQ(record.windows, 1);
  EXPECT_FALSE(service.puppet.RunNext()) << "its second window was evaluated";
  EXPECT_EQ(service.puppet.queued_windows(), 0u);
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

TEST(ServiceIdentityTest, KeepsTheCallersRequestIdAndTrace) {
  RunningService running;
  const std::string trace = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
  TimedContext context;
  context.AddMetadata("x-request-id", "shot-42/take.3");
  context.AddMetadata("traceparent", trace);
  const Reply reply = Call(running.stub(), SampleRequest(), context);
  ASSERT_TRUE(reply.status.ok());
  EXPECT_EQ(reply.messages.front().header().request_id(), "shot-42/take.3");
  const metrics::CallRecord record = running.calls().WaitFor(1);
  EXPECT_EQ(record.request_id, "shot-42/take.3");
  EXPECT_EQ(record.traceparent, trace);
  EXPECT_THAT(record.peer, HasSubstr("127.0.0.1"));
}

TEST(ServiceIdentityTest, ReplacesAnInvalidRequestId) {
  RunningService running;
  TimedContext context;
  context.AddMetadata("x-request-id", std::string(129, 'x'));
  const Reply reply = Call(running.stub(), SampleRequest(), context);
  ASSERT_TRUE(reply.status.ok());
  EXPECT_EQ(reply.messages.front().header().request_id().size(), 32u);
}

TEST(ServiceRecordTest, SaysWhatACallDid) {
  PuppetService service;
  TimedContext context;
  v1::SynthesizeRequest request = SampleRequest(46);
  request.set_priority(v1::PRIORITY_BULK);
  const auto reader = service.running.stub().Synthesize(&context, request);
  service.puppet.WaitForJobs(1);
  EXPECT_EQ(service.puppet.NextPriority(), batching::Priority::kBulk);
  service.puppet.RunNext();
  ASSERT_TRUE(ReadAll(*reader).status.ok());
  const metrics::CallRecord record = service.running.calls().WaitFor(1);
  EXPECT_TRUE(record.status.ok());
  EXPECT_EQ(record.method.name, "Synthesize");
  EXPECT_EQ(record.model, "fake");
  EXPECT_EQ(record.version, 1);
  EXPECT_EQ(record.priority, "bulk");
  EXPECT_EQ(record.frames, 46);
  EXPECT_EQ(record.chunks, 2);
  EXPECT_EQ(record.windows, 1);
  EXPECT_DOUBLE_EQ(record.queue_seconds, 0.25);
  EXPECT_DOUBLE_EQ(record.compute_seconds, 0.5);
  EXPECT_GE(record.first_chunk_seconds, 0);
  EXPECT_GE(record.total_seconds, record.first_chunk_seconds);
}

TEST(ModelMethodsTest, DescribesAModelAndItsLimits) {
  RunningService running;
  TimedContext context;
  v1::GetModelResponse response;
  ASSERT_TRUE(running.stub().GetModel(&context, v1::GetModelRequest(), &response).ok());
  const engine::ModelDescription fake = FakeDescription();
  EXPECT_EQ(response.model().name(), "fake");
  EXPECT_THAT(response.model().interaction_classes(), testing::ElementsAreArray(fake.classes));
  EXPECT_THAT(response.model().joint_names(), testing::ElementsAreArray(fake.skeleton.joint_names));
  EXPECT_EQ(response.model().bones_size(), 14);
  EXPECT_EQ(response.model().root_joint(), "torso");
  EXPECT_EQ(response.model().frame_rate_hz(), 15);
  EXPECT_EQ(response.model().window_frames(), 46u);
  EXPECT_TRUE(response.model().accepts_follower_start());
  EXPECT_FALSE(response.model().samples());
  EXPECT_EQ(response.model().description(), fake.description);
  EXPECT_EQ(response.limits().min_frame_rate_hz(), 1);
  EXPECT_EQ(response.limits().max_frame_rate_hz(), 240);
  EXPECT_EQ(response.limits().min_frames(), 2u);
  EXPECT_EQ(response.limits().max_duration_seconds(), 600);
  EXPECT_EQ(response.limits().max_chunk_frames(), 240u);
  EXPECT_EQ(response.limits().max_label_keyframes(), 4096u);
  EXPECT_EQ(response.limits().max_abs_weight(), 2);
  EXPECT_EQ(response.limits().max_variety(), 2);
  EXPECT_EQ(response.limits().max_candidates(), 16u);
  EXPECT_EQ(response.limits().max_request_bytes(), 32u << 20);
}

}  // namespace
}  // namespace duet::server::service
