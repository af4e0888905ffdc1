#include "client/cli/value_syntax.h"

#include <optional>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/request_id.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

absl::Status Expected(absl::string_view expected, absl::string_view text) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(text)));
}

constexpr double kLeastBeatsPerMinute = 20, kMostBeatsPerMinute = 400;

// "30" or "8.5b".
bool ParsePosition(absl::string_view text, KeyframeArgument* keyframe) {
  if (!absl::ConsumeSuffix(&text, "b")) {
    return absl::SimpleAtoi(text, &keyframe->frame) && keyframe->frame >= 0;
  }
  double beats = 0;
  if (!base::ParseNumber(text, &beats) || beats < 0) return false;
  keyframe->beats = beats;
  return true;
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

absl::StatusOr<KeyframeArgument> ParseKeyframe(absl::string_view text) {
  constexpr char kForm[] =
      "FRAME:CLASS=WEIGHT,... such as 30:kick=1,hug=0, or BEATSb:CLASS=WEIGHT,... such as "
      "8b:kick=1";
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits(':', 1));
  KeyframeArgument keyframe;
  if (!ParsePosition(parts.first, &keyframe)) return Expected(kForm, text);
  for (absl::string_view item : absl::StrSplit(parts.second, ',')) {
    absl::StatusOr<ClassWeight> weight = ParseClassWeight(item);
    if (!weight.ok()) return Expected(kForm, text);
    keyframe.weights.push_back(*std::move(weight));
  }
  return keyframe;
}

absl::StatusOr<motion::Beat> ParseBeat(absl::string_view text) {
  const std::pair<std::string, std::string> parts = absl::StrSplit(text, absl::MaxSplits(',', 1));
  motion::Beat beat;
  if (!base::ParseNumber(parts.first, &beat.per_minute) ||
      (absl::StrContains(text, ',') && !base::ParseNumber(parts.second, &beat.first_seconds))) {
    return Expected("BPM or BPM,OFFSET such as 180 or 180,0.25", text);
  }
  if (beat.per_minute < kLeastBeatsPerMinute || beat.per_minute > kMostBeatsPerMinute) {
    return Expected(absl::StrCat("a BPM from ", kLeastBeatsPerMinute, " to ", kMostBeatsPerMinute),
                    text);
  }
  if (beat.first_seconds < -beat.period_seconds()) {
    return Expected(absl::StrCat("an OFFSET of at least ", -beat.period_seconds(), " s (one beat)"),
                    text);
  }
  return beat;
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

absl::StatusOr<std::string> ParseRequestId(absl::string_view text) {
  absl::Status status = base::CheckRequestId(text);
  if (!status.ok()) return status;
  return std::string(text);
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
