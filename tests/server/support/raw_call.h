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

// Clients of servers on this machine. Each call ends after a minute, far longer than any call of a
// test takes, so that a call that never ends fails its test instead of hanging it.

// A client's context with that deadline, unless the test sets another one.
class TimedContext final : public grpc::ClientContext {
 public:
  TimedContext();
};

// A call with hand-written messages, for services whose protos are not available.
class RawCall {
 public:
  // Begins a call of "/package.Service/Method" and sends only its headers.
  RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method);
  // Sends one message.
  RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
          const std::string& message);
  ~RawCall();

  // Ends the messages of a call that has sent none.
  void SendNoMore();
  // Returns the next message, or nullopt at the end.
  std::optional<std::string> Read();
  grpc::Status Finish();

 private:
  bool Next();

  grpc::GenericStub stub_;
  TimedContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

// Returns the status of a service in gRPC's health service: "SERVING", "NOT_SERVING", or the call's
// error.
std::string Health(const std::shared_ptr<grpc::Channel>& channel, const std::string& service);

// Sends bytes to a port of this machine and returns everything received until the connection
// closes. Shares no code with the server's HTTP.
std::string Exchange(int port, const std::string& request);

// Returns the whole HTTP response to a GET, headers and body.
std::string HttpGet(int port, const std::string& path);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_RAW_CALL_H_
