#ifndef DUET_CLIENT_BATCH_TEXT_VALUES_H_
#define DUET_CLIENT_BATCH_TEXT_VALUES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/request.h"
#include "client/result.h"
#include "model/formats/motion_file.h"
#include "model/motion/vec3.h"
#include "nlohmann/json.hpp"

namespace duet::client::batch {

// The syntax of values in recipes, manifests and flags. Errors: INVALID_ARGUMENT 'expected ..., got
// "text"'.

// "NAME", "NAME@VERSION" or "NAME:LABEL"
absl::StatusOr<ModelChoice> ParseModelChoice(absl::string_view text);
// "NAME@VERSION". Requires a version.
std::string ModelText(const ModelChoice& model);
// "kick=1,hug=0.5", by class name. Each class once, weights within [-2, 2].
absl::StatusOr<std::vector<ClassWeight>> ParseLabels(absl::string_view text);
// "left" or "right"
absl::StatusOr<formats::Side> ParseSide(absl::string_view text);
absl::string_view SideName(formats::Side side);
inline formats::Side OtherSide(formats::Side side) {
  return side == formats::Side::kLeft ? formats::Side::kRight : formats::Side::kLeft;
}
// "7": a whole number from 0 to 2^64 - 1
absl::StatusOr<uint64_t> ParseSeed(absl::string_view text);
// "0.5,1.1,-2" in metres; nullopt if the text is not a list of three numbers, such as a file name
std::optional<motion::Vec3> ParsePoint(absl::string_view text);
// "1,0,0": a direction of any length
absl::StatusOr<motion::Vec3> ParseDirection(absl::string_view text);

void SortByClass(std::vector<ClassWeight>* labels);
// The shortest text that reads back as the same weight.
std::string WeightText(float weight);

// Pins of a follower.
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

#endif  // DUET_CLIENT_BATCH_TEXT_VALUES_H_
