#ifndef DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
#define DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_

#include "absl/status/statusor.h"
#include "client/request.h"
#include "client/result.h"
#include "duet/v1/synthesis.pb.h"

namespace duet::client::internal {

// Convert values to protos. Return INVALID_ARGUMENT, naming the field, only for values that the
// proto cannot represent. The server validates everything else.
absl::StatusOr<v1::ModelSelector> ToProto(const ModelChoice& choice);
absl::StatusOr<v1::SynthesizeRequest> ToProto(const SynthesisRequest& request);

// Convert protos to values. Return INTERNAL if the server's model is inconsistent.
absl::StatusOr<ModelInfo> FromProto(const v1::Model& model);
RequestLimits FromProto(const v1::RequestLimits& limits);
MotionGrade FromProto(const v1::MotionGrade& grade);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_PROTO_CONVERSION_H_
