#ifndef DUET_CLIENT_INTERNAL_GRPC_STUB_H_
#define DUET_CLIENT_INTERNAL_GRPC_STUB_H_

#include <memory>
#include <string>

#include "client/internal/stub.h"
#include "grpcpp/channel.h"

namespace duet::client::internal {

// Calls by gRPC, as whoever `token` says; empty: as nobody.
std::shared_ptr<Stub> MakeGrpcStub(std::shared_ptr<grpc::Channel> channel,
                                   const std::string& token = "");

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_GRPC_STUB_H_
