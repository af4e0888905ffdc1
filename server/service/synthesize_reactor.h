#ifndef DUET_SERVER_SERVICE_SYNTHESIZE_REACTOR_H_
#define DUET_SERVER_SERVICE_SYNTHESIZE_REACTOR_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <memory>

#include "absl/status/status.h"
#include "duet/v1/synthesis.pb.h"
#include "server/service/synthesis_call.h"

namespace duet::server::service {

// Joins a SynthesisCall to gRPC. Deletes itself when gRPC is done with it.
class SynthesizeReactor final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                                public ReplyWriter {
 public:
  explicit SynthesizeReactor(grpc::CallbackServerContext& context) : context_(context) {}

  // Answers with an admitted call. A refused one needs Finish alone.
  void Run(std::shared_ptr<SynthesisCall> call);

  void Write(const v1::SynthesizeResponse& reply) override;
  void Finish(CallScope& scope, const absl::Status& status) override;

  void OnWriteDone(bool ok) override { call_->OnWritten(ok); }
  void OnCancel() override;
  void OnDone() override { delete this; }

 private:
  grpc::CallbackServerContext& context_;
  std::shared_ptr<SynthesisCall> call_;
  grpc::ByteBuffer reply_;  // being written
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_SYNTHESIZE_REACTOR_H_
