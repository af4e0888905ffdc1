#ifndef DUET_CLIENT_INTERNAL_GRPC_STUB_H_
#define DUET_CLIENT_INTERNAL_GRPC_STUB_H_

#include <memory>
#include <string>

#include "client/internal/stub.h"
#include "grpcpp/channel.h"

namespace duet::client::internal {

// Creates a stub that calls over gRPC with `token` as credentials; empty: without credentials.
std::shared_ptr<Stub> MakeGrpcStub(std::shared_ptr<grpc::Channel> channel,
                                   const std::string& token = "");

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_GRPC_STUB_H_
