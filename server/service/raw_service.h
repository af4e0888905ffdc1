#ifndef DUET_SERVER_SERVICE_RAW_SERVICE_H_
#define DUET_SERVER_SERVICE_RAW_SERVICE_H_

#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <functional>

namespace duet::server::service {

// A gRPC service whose methods get their calls as soon as the headers have come, and bytes for
// messages. What protoc generates gets a call with its message read, whatever its size, and while
// however many others are being read: too late to admit it.
class RawService : public grpc::Service {
 protected:
  using Reactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  // Serves "/package.Service/Method", a literal. `open` must not block, and gives a reactor that
  // owns itself.
  void Serve(const char* method, std::function<Reactor*(grpc::CallbackServerContext*)> open);

 private:
  int methods_ = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_RAW_SERVICE_H_
