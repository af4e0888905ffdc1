#ifndef DUET_SERVER_SERVICE_REQUEST_FIELDS_H_
#define DUET_SERVER_SERVICE_REQUEST_FIELDS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "duet/v1/motion.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "model/engine/label_track.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesis_options.h"
#include "model/motion/coordinates.h"
#include "model/motion/levelling.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

// The fields of a request, read and checked one by one. validator.h and validate_live.h read whole
// messages.

namespace duet::server::service {

// The leader (validate_leader.cc).

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

// Labels (validate_labels.cc).

// Reads the request's label vector or keyframes, in the model's class order. A label vector becomes
// one keyframe at frame 0. `frames`: keyframes lie before this frame. Adds every invalid field to
// `violations`; the result is then meaningless.
std::vector<engine::LabelKeyframe> ValidateLabels(const v1::SynthesizeRequest& request,
                                                  uint32_t frames,
                                                  const engine::ModelDescription& model,
                                                  const RequestLimits& limits,
                                                  Violations& violations);

// Reads one label vector, the field `field`, in the model's class order. Shapes: returns [classes].
std::vector<float> ReadLabelVector(const std::string& field, const v1::LabelVector& label_vector,
                                   const engine::ModelDescription& model,
                                   const RequestLimits& limits, Violations& violations);

// Options and constraints (validate_options.cc).

// Reads the optional fields of a request that configure the synthesis: seed, variety, clean_up.
// Adds every invalid field to `violations`; the result is then meaningless.
engine::SynthesisOptions ValidateOptions(const v1::SynthesizeRequest& request,
                                         const RequestLimits& limits, Violations& violations);

// The world of a request, as far as it is valid. The result for `constraints` is complete only if
// it is.
struct RequestWorld {
  std::optional<motion::Coordinates> coordinates;
  std::optional<motion::Levelling> levelling;
  const motion::Poses& leader;  // level world metres, the model's joints; empty if it is invalid
};

// Converts SynthesizeRequest.constraints to pins in the caller's frames, the model's joints and
// level world metres, in the same order. Adds every invalid one to `violations`; the result is then
// meaningless.
motion::Pins ValidateConstraints(const v1::SynthesizeRequest& request, const RequestWorld& world,
                                 const engine::ModelDescription& model, const RequestLimits& limits,
                                 Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REQUEST_FIELDS_H_
