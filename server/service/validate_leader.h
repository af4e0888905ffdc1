#ifndef DUET_SERVER_SERVICE_VALIDATE_LEADER_H_
#define DUET_SERVER_SERVICE_VALIDATE_LEADER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "duet/v1/motion.pb.h"
#include "model/engine/model_description.h"
#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Adds a violation under `field` if the poses, in metres, are far larger or smaller than a person:
// positions in another unit than the declared one. Single lost joints and frames do not matter: a
// tracker that has lost the person reports most joints in one place, even in most of the frames.
// But in some frame, some joint must be elsewhere. Accepts poses without frames.
void ValidateSize(absl::string_view field, const motion::Poses& poses, Violations& violations);

// Whether all joints of a pose are in one place: a tracker has lost the person.
bool IsPoint(absl::Span<const motion::Vec3> pose);

// A longer list of joint names is rejected as a whole, without a violation for each name.
inline constexpr int kMaxJointNames = 1024;

// Returns the unit and up axis of a motion. Absent, with violations, if they are invalid.
std::optional<motion::Coordinates> ValidateCoordinates(const v1::Motion& leader,
                                                       Violations& violations);

// Returns the index in the model of each joint of the leader. Empty, with violations, unless the
// names are the model's joints in any order.
std::vector<int> ValidateJoints(const v1::Motion& leader, const engine::ModelDescription& model,
                                Violations& violations);

// Checks frame rate, frame count and duration.
void ValidateTiming(const v1::Motion& leader, const RequestLimits& limits, Violations& violations);

// Converts the caller's flat positions [frames, joints, 3] to world poses in the model's joint
// order. Empty, with violations under `field`, if a value is not finite or exceeds
// RequestLimits::max_abs_coordinate_metres. Requires a whole number of frames.
motion::Poses ReadPositions(absl::string_view field,
                            const google::protobuf::RepeatedField<float>& positions,
                            const std::vector<int>& joints, const motion::Coordinates& coordinates,
                            const RequestLimits& limits, Violations& violations);

// Adds a violation unless there are three values for each joint of each frame; without `frames`, of
// one pose. Returns whether there are.
bool ValidateCount(absl::string_view field, int values, std::optional<uint32_t> frames, int joints,
                   Violations& violations);

// Returns true if all values are finite. Otherwise adds violations for the first few and a count.
bool ValidateFinite(absl::string_view field,
                    const google::protobuf::RepeatedField<float>& positions,
                    Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_LEADER_H_
