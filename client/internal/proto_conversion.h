#ifndef DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
#define DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_

#include "absl/status/statusor.h"
#include "client/request.h"
#include "client/result.h"
#include "duet/v1/synthesis.pb.h"

namespace duet::client::internal {

// Values to the wire. INVALID_ARGUMENT, naming the field, only for what the wire cannot carry; all
// else is the server's to judge.
absl::StatusOr<v1::ModelSelector> ToProto(const ModelChoice& choice);
absl::StatusOr<v1::SynthesizeRequest> ToProto(const SynthesisRequest& request);

// The wire to values. INTERNAL when the server describes a model that cannot be.
absl::StatusOr<ModelInfo> FromProto(const v1::Model& model);
RequestLimits FromProto(const v1::RequestLimits& limits);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
