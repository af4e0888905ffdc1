#ifndef DUET_TESTS_CLIENT_SUPPORT_FAKE_SERVICE_H_
#define DUET_TESTS_CLIENT_SUPPORT_FAKE_SERVICE_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/time/time.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/security/server_credentials.h"
#include "grpcpp/server.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/sync_stream.h"

namespace duet::test {

// The longest that a test waits for a call that ought to end at once: a defect then ends in a
// failure rather than in a test that hangs.
inline constexpr absl::Duration kLongestCall = absl::Seconds(60);

// A service whose answers a test writes.
class FakeService final : public v1::MotionSynthesis::Service {
 public:
  std::function<grpc::Status(grpc::ServerContext*, v1::ListModelsResponse*)> on_list_models;
  std::function<grpc::Status(const v1::GetModelRequest&, v1::GetModelResponse*)> on_get_model;
  std::function<grpc::Status(grpc::ServerContext*, const v1::SynthesizeRequest&,
                             grpc::ServerWriter<v1::SynthesizeResponse>*)>
      on_synthesize;
  std::function<grpc::Status(
      grpc::ServerContext*,
      grpc::ServerReaderWriter<v1::SynthesizeLiveResponse, v1::SynthesizeLiveRequest>*)>
      on_live;

  grpc::Status ListModels(grpc::ServerContext* context, const v1::ListModelsRequest*,
                          v1::ListModelsResponse* response) override {
    return on_list_models(context, response);
  }
  grpc::Status GetModel(grpc::ServerContext*, const v1::GetModelRequest* request,
                        v1::GetModelResponse* response) override {
    return on_get_model(*request, response);
  }
  grpc::Status Synthesize(grpc::ServerContext* context, const v1::SynthesizeRequest* request,
                          grpc::ServerWriter<v1::SynthesizeResponse>* writer) override {
    return on_synthesize(context, *request, writer);
  }
  grpc::Status SynthesizeLive(
      grpc::ServerContext* context,
      grpc::ServerReaderWriter<v1::SynthesizeLiveResponse, v1::SynthesizeLiveRequest>* stream)
      override {
    return on_live(context, stream);
  }
};

// A FakeService on a free port of this machine, with gRPC's own health service.
class FakeServer {
 public:
  explicit FakeServer(
      std::shared_ptr<grpc::ServerCredentials> credentials = grpc::InsecureServerCredentials());
  ~FakeServer();

  FakeService& service() { return service_; }
  // What the health service says of the server as a whole; true at first.
  void SetServing(bool serving);
  // Ends the server at once, and with it all calls.
  void Kill();
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  FakeService service_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_SUPPORT_FAKE_SERVICE_H_
