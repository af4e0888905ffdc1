#ifndef DUET_SERVER_SERVICE_VALIDATE_LEADER_H_
#define DUET_SERVER_SERVICE_VALIDATE_LEADER_H_

#include <optional>
#include <vector>

#include "absl/strings/string_view.h"
#include "duet/v1/motion.pb.h"
#include "model/engine/model_description.h"
#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

namespace duet::server::service {

// A list of more joint names than this is refused as a whole, without a word on each.
inline constexpr int kMaxJointNames = 1024;

// The unit and up axis of a motion; nothing, and violations, when they cannot be interpreted.
std::optional<motion::Coordinates> ValidateCoordinates(const v1::Motion& leader,
                                                       Violations& violations);

// For every joint of the leader, its index in the model; empty, and violations, unless the names
// are the model's joints in some order.
std::vector<int> ValidateJoints(const v1::Motion& leader, const engine::ModelDescription& model,
                                Violations& violations);

// Rate, frame count and duration.
void ValidateTiming(const v1::Motion& leader, const RequestLimits& limits, Violations& violations);

// Reads flat positions [frames, joints, 3] of the caller as poses in the world, in the model's
// joint order. Empty, and violations under `field`, when a value is not finite or
// absurdly far away. `positions` holds a whole number of frames of `joints`.
motion::Poses ReadPositions(absl::string_view field,
                            const google::protobuf::RepeatedField<float>& positions,
                            const std::vector<int>& joints, const motion::Coordinates& coordinates,
                            const RequestLimits& limits, Violations& violations);

// Names the first few values that are not finite, and counts them all. True when there are none.
bool ValidateFinite(absl::string_view field,
                    const google::protobuf::RepeatedField<float>& positions,
                    Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_LEADER_H_
