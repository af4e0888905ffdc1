#ifndef DUET_CLIENT_BATCH_TEXT_VALUES_H_
#define DUET_CLIENT_BATCH_TEXT_VALUES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/request.h"
#include "model/formats/motion_file.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

// The syntax of values in recipes, manifests and flags. Errors: INVALID_ARGUMENT 'expected ..., got
// "text"'.

// 'expected <what>, got "<text>"'
absl::Status Expected(absl::string_view what, absl::string_view text);
// "NAME", "NAME@VERSION" or "NAME:LABEL"
absl::StatusOr<ModelChoice> ParseModelChoice(absl::string_view text);
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

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_TEXT_VALUES_H_
