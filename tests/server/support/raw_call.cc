#include "tests/server/support/raw_call.h"

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

#include <vector>

#include "tests/server/support/timed_context.h"

namespace duet::test {

RawCall::RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                 const std::string& message)
    : stub_(channel) {
  LimitCall(context_);
  call_ = stub_.PrepareCall(&context_, method, &queue_);
  const grpc::Slice slice(message);
  call_->StartCall(nullptr);
  Next();
  call_->WriteLast(grpc::ByteBuffer(&slice, 1), grpc::WriteOptions(), nullptr);
  Next();
}

RawCall::~RawCall() {
  context_.TryCancel();
  queue_.Shutdown();
  while (Next()) {
  }
}

std::optional<std::string> RawCall::Read() {
  grpc::ByteBuffer buffer;
  call_->Read(&buffer, nullptr);
  if (!Next()) return std::nullopt;
  std::vector<grpc::Slice> slices;
  if (!buffer.Dump(&slices).ok()) return std::nullopt;
  std::string message;
  for (const grpc::Slice& slice : slices) {
    message.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  return message;
}

grpc::Status RawCall::Finish() {
  grpc::Status status;
  call_->Finish(&status, nullptr);
  Next();
  return status;
}

bool RawCall::Next() {
  void* tag = nullptr;
  bool ok = false;
  return queue_.Next(&tag, &ok) && ok;
}

std::string Health(const std::shared_ptr<grpc::Channel>& channel, const std::string& service) {
  // HealthCheckRequest{service = 1}, HealthCheckResponse{status = 1: 1 SERVING, 2 NOT_SERVING}.
  const std::string request =
      service.empty() ? "" : "\x0a" + std::string(1, static_cast<char>(service.size())) + service;
  RawCall call(channel, "/grpc.health.v1.Health/Check", request);
  const std::optional<std::string> response = call.Read();
  if (!response.has_value()) return call.Finish().error_message();
  return *response == "\x08\x01" ? "SERVING" : *response == "\x08\x02" ? "NOT_SERVING" : *response;
}

}  // namespace duet::test
