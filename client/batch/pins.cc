#include "client/batch/pins.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/batch/text_values.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

absl::Status Expected(absl::string_view what, absl::string_view text) {
  return absl::InvalidArgumentError(absl::StrCat("expected ", what, ", got ", base::Quoted(text)));
}

std::string NumbersText(const JointConstraint& pin) {
  std::string text = absl::StrCat(WeightText(pin.position.x), ",", WeightText(pin.position.y), ",",
                                  WeightText(pin.position.z));
  if (pin.softness != 0) absl::StrAppend(&text, ",", WeightText(pin.softness));
  return text;
}

}  // namespace

absl::StatusOr<JointConstraint> ParsePin(absl::string_view text) {
  constexpr char kForm[] =
      "JOINT@FRAME=X,Y,Z[,SOFTNESS] such as right_hand@40=0.2,1.3,0.5 (metres, y up; softness from "
      "0 to 1)";
  const std::pair<absl::string_view, absl::string_view> sides =
      absl::StrSplit(text, absl::MaxSplits('=', 1));
  const std::pair<std::string, absl::string_view> place =
      absl::StrSplit(sides.first, absl::MaxSplits('@', 1));
  std::vector<absl::string_view> numbers = absl::StrSplit(sides.second, ',');
  JointConstraint pin;
  pin.joint = place.first;
  if (numbers.size() == 4) {
    // Negated, so that NaN is rejected.
    if (!absl::SimpleAtof(numbers.back(), &pin.softness) ||
        !(pin.softness >= 0 && pin.softness <= 1)) {
      return Expected(kForm, text);
    }
    numbers.pop_back();
  }
  const std::optional<motion::Vec3> position = ParsePoint(absl::StrJoin(numbers, ","));
  if (pin.joint.empty() || !absl::SimpleAtoi(place.second, &pin.frame) || pin.frame < 0 ||
      !position || !IsFinite(*position)) {
    return Expected(kForm, text);
  }
  pin.position = *position;
  return pin;
}

absl::StatusOr<Pins> ParsePins(absl::string_view text) {
  Pins pins;
  std::set<std::pair<std::string, int>> places;
  for (const absl::string_view item : absl::StrSplit(text, ';')) {
    absl::StatusOr<JointConstraint> pin = ParsePin(item);
    if (!pin.ok()) return pin.status();
    if (!places.emplace(pin->joint, pin->frame).second) {
      return Expected("each joint once in a frame", text);
    }
    pins.push_back(*std::move(pin));
  }
  return pins;
}

std::string PinText(const JointConstraint& pin) {
  return absl::StrCat(pin.joint, "@", pin.frame, "=", NumbersText(pin));
}

nlohmann::ordered_json PinsJson(const Pins& pins, const std::vector<float>& metres) {
  const auto number = [](float value) { return nlohmann::ordered_json::parse(WeightText(value)); };
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const JointConstraint& pin = pins[i];
    const motion::Vec3& at = pin.position;
    list.push_back({{"joint_name", pin.joint},
                    {"frame", pin.frame},
                    {"position", {number(at.x), number(at.y), number(at.z)}},
                    {"softness", number(pin.softness)}});
    if (i < metres.size()) list.back()["remaining_metres"] = number(metres[i]);
  }
  return list;
}

absl::Status CheckPinJoints(const Pins& pins, const ModelInfo& model) {
  const auto& known = model.joint_names;
  for (const JointConstraint& pin : pins) {
    if (std::find(known.begin(), known.end(), pin.joint) != known.end()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("constraints: expected joints of ", model.name, "@", model.version, " (",
                     absl::StrJoin(known, ", "), "), got ", base::Quoted(pin.joint)));
  }
  return absl::OkStatus();
}

}  // namespace duet::client::batch
