#ifndef DUET_CLIENT_BATCH_TEXT_VALUES_H_
#define DUET_CLIENT_BATCH_TEXT_VALUES_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/request.h"
#include "model/formats/motion_file.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

// How values are written in recipes and manifests. Errors: INVALID_ARGUMENT with what came and what
// was wanted.

// "NAME", "NAME@VERSION" or "NAME:LABEL"
absl::StatusOr<ModelChoice> ParseModelName(absl::string_view text);
// "NAME@VERSION" of a version that is settled.
std::string ModelText(const ModelChoice& model);
// "kick=1,hug=0.5", by class name. Each class once, weights within [-2, 2].
absl::StatusOr<std::vector<ClassWeight>> ParseLabels(absl::string_view text);
// "left" or "right"
absl::StatusOr<formats::Side> ParseSide(absl::string_view text);
absl::string_view SideName(formats::Side side);
inline formats::Side OtherSide(formats::Side side) {
  return side == formats::Side::kLeft ? formats::Side::kRight : formats::Side::kLeft;
}
// "X,Y,Z"; nothing for anything else
std::optional<motion::Vec3> ParseTriple(absl::string_view text);

void SortByClass(std::vector<ClassWeight>* labels);
// The shortest text that reads back as the same weight.
std::string WeightText(float weight);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_TEXT_VALUES_H_
