#include "server/service/raw_service.h"

#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_method.h>
#include <grpcpp/impl/rpc_service_method.h>

#include <utility>

#include "server/common/activity.h"

namespace duet::server::service {
namespace {

constexpr common::StepKind kOpening{"gRPC callback", "starting a call"};

}  // namespace

// Does what the constructors of generated services do. gRPC itself serves unary methods as streams
// this way (grpc::Service::MarkMethodStreamed).
void RawService::Serve(const char* method,
                       std::function<Reactor*(grpc::CallbackServerContext*)> open) {
  using grpc::internal::CallbackBidiHandler;
  using grpc::internal::RpcMethod;
  using grpc::internal::RpcServiceMethod;
  AddMethod(new RpcServiceMethod(method, RpcMethod::BIDI_STREAMING, nullptr));
  MarkMethodRawCallback(methods_++,
                        new CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                            [open = std::move(open)](grpc::CallbackServerContext* context) {
                              const common::Step step(kOpening);
                              return open(context);
                            }));
}

}  // namespace duet::server::service
