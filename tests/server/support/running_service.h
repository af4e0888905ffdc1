#ifndef DUET_TESTS_SERVER_SUPPORT_RUNNING_SERVICE_H_
#define DUET_TESTS_SERVER_SUPPORT_RUNNING_SERVICE_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "duet/v1/synthesis.grpc.pb.h"
#include "server/batching/window_scheduler.h"
#include "server/lifecycle/grpc_server.h"
#include "server/registry/model_registry.h"
#include "server/service/admission.h"
#include "server/service/motion_synthesis_service.h"
#include "tests/server/support/fakes.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::test {

// The service behind real gRPC on a free port, with a fake model and whatever scheduler a test
// wants.
class RunningService {
 public:
  struct Setup {
    Setup();  // limits and buffer as the server's defaults

    std::shared_ptr<const engine::Synthesizer> model = std::make_shared<FakeSynthesizer>();
    server::batching::WindowScheduler* scheduler = nullptr;  // null: a batcher with two workers
    server::service::AdmissionLimits admission;              // 16 calls
    server::service::RequestLimits limits;
    server::service::ReceptionLimits reception;
    const server::common::Clock* clock = &server::common::Clock::Real();
    double write_timeout_seconds = std::numeric_limits<double>::infinity();
    double max_call_seconds = std::numeric_limits<double>::infinity();
    std::string client_key;
    int buffered_frames = 0;
    std::optional<bool> clean_up;  // see ServiceParts
  };

  explicit RunningService(Setup setup);
  RunningService() : RunningService(Setup()) {}
  explicit RunningService(server::batching::WindowScheduler* scheduler);
  ~RunningService();

  v1::MotionSynthesis::Stub& stub() { return *stub_; }
  std::string address() const;  // "127.0.0.1:PORT"
  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }
  RecordingObserver& calls() { return calls_; }
  server::service::Admission& admission() { return admission_; }
  server::service::MotionSynthesisService& service() { return *service_; }

 private:
  RecordingObserver calls_;
  server::registry::ModelRegistry registry_;
  server::service::Admission admission_;
  std::unique_ptr<server::batching::WindowScheduler> batcher_;
  std::unique_ptr<server::service::MotionSynthesisService> service_;
  server::lifecycle::GrpcServer grpc_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
};

// A whole reply stream.
struct Reply {
  std::vector<v1::SynthesizeResponse> messages;
  grpc::Status status;

  // The positions of all chunks, in order.
  std::vector<float> Positions() const;
  // The chunks' sizes in frames.
  std::vector<int> ChunkFrames() const;
};

// Reads what is left of a stream.
Reply ReadAll(grpc::ClientReader<v1::SynthesizeResponse>& reader);

// Makes a call and reads its reply; without a context of the test's own, under TimedContext.
Reply Call(v1::MotionSynthesis::Stub& stub, const v1::SynthesizeRequest& request);
Reply Call(v1::MotionSynthesis::Stub& stub, const v1::SynthesizeRequest& request,
           grpc::ClientContext& context);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_RUNNING_SERVICE_H_
