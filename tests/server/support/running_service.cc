#include "tests/server/support/running_service.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/batching/window_queue.h"
#include "server/config/settings.h"
#include "tests/server/support/raw_call.h"

namespace duet::test {

RunningService::Setup::Setup() {
  const v1::ServerConfig defaults =
      server::config::ReadSettings(v1::ServerConfig(), /*cores=*/1).values;
  admission.max_calls = 16;
  limits.max_request_bytes = defaults.max_request_bytes();
  buffered_frames = static_cast<int>(defaults.buffered_frames());
}

RunningService::RunningService(Setup setup) : admission_(setup.admission) {
  registry_.Serve(std::move(setup.model));
  admission_.SetState(server::service::Admission::State::kServing);
  if (setup.scheduler == nullptr) {
    batcher_ = server::batching::MakeBatcher({2, 64, {4}}, server::common::Clock::Real());
    setup.scheduler = batcher_.get();
  }
  server::service::ServiceParts parts;
  parts.registry = &registry_;
  parts.scheduler = setup.scheduler;
  parts.admission = &admission_;
  parts.observers = {&calls_};
  parts.limits = setup.limits;
  parts.reception = setup.reception;
  parts.clock = setup.clock;
  parts.write_timeout_seconds = setup.write_timeout_seconds;
  parts.max_call_seconds = setup.max_call_seconds;
  parts.client_key = setup.client_key;
  parts.buffered_frames = setup.buffered_frames;
  parts.clean_up = setup.clean_up;
  service_ = std::make_unique<server::service::MotionSynthesisService>(parts);
  absl::StatusOr<server::lifecycle::GrpcServer> grpc = server::lifecycle::StartGrpcServer(
      {{"127.0.0.1", 0}, false, setup.limits.max_request_bytes, std::size_t{512} << 20, 16},
      *service_);
  if (!grpc.ok()) {
    ADD_FAILURE() << grpc.status();
    return;
  }
  grpc_ = *std::move(grpc);
  channel_ = grpc::CreateChannel(address(), grpc::InsecureChannelCredentials());
  stub_ = v1::MotionSynthesis::NewStub(channel_);
}

std::string RunningService::address() const { return absl::StrCat("127.0.0.1:", grpc_.port); }

RunningService::RunningService(server::batching::WindowScheduler* scheduler)
    : RunningService([scheduler] {
        Setup setup;
        setup.scheduler = scheduler;
        return setup;
      }()) {}

RunningService::~RunningService() {
  if (grpc_.server == nullptr) return;
  service_->AbortAll(absl::UnavailableError("the test is over"));
  grpc_.server->Shutdown(std::chrono::system_clock::now());
}

std::vector<float> Reply::Positions() const {
  std::vector<float> positions;
  for (const v1::SynthesizeResponse& message : messages) {
    positions.insert(positions.end(), message.chunk().positions().begin(),
                     message.chunk().positions().end());
  }
  return positions;
}

std::vector<int> Reply::ChunkFrames() const {
  std::vector<int> frames;
  for (const v1::SynthesizeResponse& message : messages) {
    if (message.has_chunk()) frames.push_back(static_cast<int>(message.chunk().frame_count()));
  }
  return frames;
}

Reply ReadAll(grpc::ClientReader<v1::SynthesizeResponse>& reader) {
  Reply reply;
  v1::SynthesizeResponse message;
  while (reader.Read(&message)) reply.messages.push_back(message);
  reply.status = reader.Finish();
  return reply;
}

Reply Call(v1::MotionSynthesis::Stub& stub, const v1::SynthesizeRequest& request) {
  TimedContext context;
  return Call(stub, request, context);
}

Reply Call(v1::MotionSynthesis::Stub& stub, const v1::SynthesizeRequest& request,
           grpc::ClientContext& context) {
  const auto reader = stub.Synthesize(&context, request);
  return ReadAll(*reader);
}

}  // namespace duet::test
