#include "client/cli/value_syntax.h"

#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

absl::Status Expected(absl::string_view expected, absl::string_view text) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(text)));
}

}  // namespace

absl::StatusOr<ClassWeight> ParseClassWeight(absl::string_view text) {
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits('=', 1));
  ClassWeight weight{parts.first, 1};
  const bool has_weight = absl::StrContains(text, '=');
  if (weight.interaction_class.empty() ||
      (has_weight && !absl::SimpleAtof(parts.second, &weight.weight))) {
    return Expected("CLASS or CLASS=WEIGHT such as kick or kick=0.5", text);
  }
  return weight;
}

absl::StatusOr<WeightKeyframe> ParseKeyframe(absl::string_view text) {
  constexpr char kForm[] = "FRAME:CLASS=WEIGHT,... such as 30:kick=1,hug=0";
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits(':', 1));
  WeightKeyframe keyframe;
  if (!absl::SimpleAtoi(parts.first, &keyframe.frame) || keyframe.frame < 0) {
    return Expected(kForm, text);
  }
  for (absl::string_view item : absl::StrSplit(parts.second, ',')) {
    absl::StatusOr<ClassWeight> weight = ParseClassWeight(item);
    if (!weight.ok()) return Expected(kForm, text);
    keyframe.weights.push_back(*std::move(weight));
  }
  return keyframe;
}

absl::StatusOr<std::pair<std::string, std::string>> ParseJointPair(absl::string_view text) {
  std::pair<std::string, std::string> joints = absl::StrSplit(text, absl::MaxSplits('=', 1));
  if (joints.first.empty() || joints.second.empty()) {
    return Expected("MODEL_JOINT=FILE_JOINT such as left_hand=LeftWrist", text);
  }
  return joints;
}

absl::StatusOr<float> ParseVariety(absl::string_view text) {
  float variety = 0;
  if (absl::SimpleAtof(text, &variety) && variety >= 0 && variety <= 2) return variety;
  return Expected("a number from 0 to 2", text);
}

absl::StatusOr<motion::LengthUnit> ParseUnit(absl::string_view text) {
  const std::optional<motion::LengthUnit> unit = motion::ParseLengthUnit(text);
  if (unit.has_value()) return *unit;
  return Expected(motion::kLengthUnitNames, text);
}

absl::StatusOr<motion::UpAxis> ParseAxis(absl::string_view text) {
  const std::optional<motion::UpAxis> axis = motion::ParseUpAxis(text);
  if (axis.has_value()) return *axis;
  return Expected(motion::kUpAxisNames, text);
}

}  // namespace duet::client::cli
