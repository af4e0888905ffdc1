#ifndef DUET_CLIENT_BATCH_PINS_H_
#define DUET_CLIENT_BATCH_PINS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/request.h"
#include "client/result.h"
#include "nlohmann/json.hpp"

// Pins of a follower as text and JSON, and their check before the first call.

namespace duet::client::batch {

using Pins = std::vector<JointConstraint>;

// "right_hand@40=0.2,1.3,0.5", or "right_hand@40=0.2,1.3,0.5,0.3" with a softness: a joint of the
// model, a frame, and metres, y up. Errors: INVALID_ARGUMENT 'expected ..., got "text"'.
absl::StatusOr<JointConstraint> ParsePin(absl::string_view text);
// Several, separated by semicolons. At least one; each joint at most once in a frame.
absl::StatusOr<Pins> ParsePins(absl::string_view text);
// The shortest text that ParsePin reads back as the same pin.
std::string PinText(const JointConstraint& pin);

// The fields have the names of duet.v1.JointConstraint; remaining_metres is what remains, where
// `metres` (SynthesisResult::constraint_metres) has it.
nlohmann::ordered_json PinsJson(const Pins& pins, const std::vector<float>& metres);

// Checks that a model has the joints of all pins. Errors: INVALID_ARGUMENT "constraints: ...".
absl::Status CheckPinJoints(const Pins& pins, const ModelInfo& model);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PINS_H_
