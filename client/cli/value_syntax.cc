#include "client/cli/value_syntax.h"

#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

absl::Status Wanted(absl::string_view text, absl::string_view wanted) {
  return absl::InvalidArgumentError(absl::StrCat(base::Quoted(text), ", wanted ", wanted));
}

}  // namespace

absl::StatusOr<ClassWeight> ParseClassWeight(absl::string_view text) {
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits('=', 1));
  ClassWeight weight{parts.first, 0};
  if (weight.interaction_class.empty() || !absl::SimpleAtof(parts.second, &weight.weight)) {
    return Wanted(text, "CLASS=WEIGHT such as kick=1");
  }
  return weight;
}

absl::StatusOr<WeightKeyframe> ParseKeyframe(absl::string_view text) {
  constexpr char kForm[] = "FRAME:CLASS=WEIGHT,... such as 30:kick=1,hug=0";
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits(':', 1));
  WeightKeyframe keyframe;
  if (!absl::SimpleAtoi(parts.first, &keyframe.frame) || keyframe.frame < 0) {
    return Wanted(text, kForm);
  }
  for (absl::string_view item : absl::StrSplit(parts.second, ',')) {
    absl::StatusOr<ClassWeight> weight = ParseClassWeight(item);
    if (!weight.ok()) return Wanted(text, kForm);
    keyframe.weights.push_back(*std::move(weight));
  }
  return keyframe;
}

absl::StatusOr<ModelChoice> ParseModelChoice(absl::string_view text) {
  constexpr char kForm[] = "NAME, NAME@VERSION or NAME:LABEL";
  ModelChoice choice;
  const size_t mark = text.find_first_of("@:");
  choice.name = std::string(text.substr(0, mark));
  if (choice.name.empty()) return Wanted(text, kForm);
  if (mark == absl::string_view::npos) return choice;
  const absl::string_view rest = text.substr(mark + 1);
  if (text[mark] == ':') {
    choice.version_label = std::string(rest);
    return rest.empty() ? absl::StatusOr<ModelChoice>(Wanted(text, kForm)) : choice;
  }
  if (!absl::SimpleAtoi(rest, &choice.version.emplace()) || *choice.version < 1) {
    return Wanted(text, absl::StrCat(kForm, ", a version being a number from 1"));
  }
  return choice;
}

absl::StatusOr<std::pair<std::string, std::string>> ParseJointPair(absl::string_view text) {
  std::pair<std::string, std::string> joints = absl::StrSplit(text, absl::MaxSplits('=', 1));
  if (joints.first.empty() || joints.second.empty()) {
    return Wanted(text, "MODEL_JOINT=FILE_JOINT such as left_hand=LeftWrist");
  }
  return joints;
}

absl::StatusOr<uint64_t> ParseSeed(absl::string_view text) {
  uint64_t seed = 0;
  if (absl::SimpleAtoi(text, &seed)) return seed;
  return Wanted(text, "a whole number from 0 to 18446744073709551615");
}

absl::StatusOr<float> ParseVariety(absl::string_view text) {
  float variety = 0;
  if (absl::SimpleAtof(text, &variety) && variety >= 0 && variety <= 2) return variety;
  return Wanted(text, "a number from 0 to 2");
}

std::optional<motion::Vec3> ParsePoint(absl::string_view text) {
  const std::vector<absl::string_view> parts = absl::StrSplit(text, ',');
  motion::Vec3 point;
  if (parts.size() != 3 || !absl::SimpleAtof(parts[0], &point.x) ||
      !absl::SimpleAtof(parts[1], &point.y) || !absl::SimpleAtof(parts[2], &point.z)) {
    return std::nullopt;
  }
  return point;
}

absl::StatusOr<motion::Vec3> ParseDirection(absl::string_view text) {
  if (const std::optional<motion::Vec3> direction = ParsePoint(text); direction.has_value()) {
    return *direction;
  }
  return absl::InvalidArgumentError(
      absl::StrCat(base::Quoted(text), ", wanted X,Y,Z such as 1,0,0"));
}

absl::StatusOr<motion::LengthUnit> ParseUnit(absl::string_view text) {
  const std::optional<motion::LengthUnit> unit = motion::ParseLengthUnit(text);
  if (unit.has_value()) return *unit;
  return Wanted(text, motion::kLengthUnitNames);
}

absl::StatusOr<motion::UpAxis> ParseAxis(absl::string_view text) {
  const std::optional<motion::UpAxis> axis = motion::ParseUpAxis(text);
  if (axis.has_value()) return *axis;
  return Wanted(text, motion::kUpAxisNames);
}

}  // namespace duet::client::cli
