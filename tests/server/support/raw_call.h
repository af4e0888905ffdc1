#ifndef DUET_TESTS_SERVER_SUPPORT_RAW_CALL_H_
#define DUET_TESTS_SERVER_SUPPORT_RAW_CALL_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/status.h>

#include <memory>
#include <optional>
#include <string>

namespace duet::test {

// A call with hand-written messages, for services whose protos are not available. Ends after
// kCallLimit.
class RawCall {
 public:
  // Sends one message to "/package.Service/Method".
  RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
          const std::string& message);
  ~RawCall();

  // Returns the next message, or nullopt at the end.
  std::optional<std::string> Read();
  // Ends the call early.
  void Cancel() { context_.TryCancel(); }
  grpc::Status Finish();

 private:
  bool Next();

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

// Returns the status of a service in gRPC's health service: "SERVING", "NOT_SERVING", or the call's
// error.
std::string Health(const std::shared_ptr<grpc::Channel>& channel, const std::string& service);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_RAW_CALL_H_
