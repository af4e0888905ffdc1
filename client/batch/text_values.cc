#include "client/batch/text_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

constexpr float kMaxAbsWeight = 2;

}  // namespace

absl::Status Expected(absl::string_view what, absl::string_view text) {
  return absl::InvalidArgumentError(absl::StrCat("expected ", what, ", got ", base::Quoted(text)));
}

absl::StatusOr<ModelChoice> ParseModelChoice(absl::string_view text) {
  constexpr char kForm[] = "NAME, NAME@VERSION or NAME:LABEL";
  const size_t mark = text.find_first_of("@:");
  ModelChoice choice;
  choice.name = std::string(text.substr(0, mark));
  if (choice.name.empty()) return Expected(kForm, text);
  if (mark == absl::string_view::npos) return choice;
  const absl::string_view rest = text.substr(mark + 1);
  if (text[mark] == ':') {
    choice.version_label = std::string(rest);
    return rest.empty() ? absl::StatusOr<ModelChoice>(Expected(kForm, text)) : choice;
  }
  if (!absl::SimpleAtoi(rest, &choice.version.emplace()) || *choice.version < 1) {
    return Expected(absl::StrCat(kForm, ", a version being a number from 1"), text);
  }
  return choice;
}

absl::StatusOr<std::vector<ClassWeight>> ParseLabels(absl::string_view text) {
  constexpr char kForm[] = "CLASS=WEIGHT,... such as kick=1,hug=0.5, weights from -2 to 2";
  std::vector<ClassWeight> labels;
  for (const absl::string_view item : absl::StrSplit(text, ',')) {
    const std::pair<std::string, std::string> parts = absl::StrSplit(item, absl::MaxSplits('=', 1));
    float weight = 0;
    if (parts.first.empty() || !absl::SimpleAtof(parts.second, &weight) ||
        !(std::abs(weight) <= kMaxAbsWeight)) {
      return Expected(kForm, text);
    }
    labels.push_back({parts.first, weight});
  }
  SortByClass(&labels);
  for (size_t i = 1; i < labels.size(); ++i) {
    if (labels[i].interaction_class == labels[i - 1].interaction_class) {
      return Expected("each class once", text);
    }
  }
  return labels;
}

absl::StatusOr<formats::Side> ParseSide(absl::string_view text) {
  if (text == "left") return formats::Side::kLeft;
  if (text == "right") return formats::Side::kRight;
  return Expected("left or right", text);
}

absl::string_view SideName(formats::Side side) {
  return side == formats::Side::kLeft ? "left" : "right";
}

absl::StatusOr<uint64_t> ParseSeed(absl::string_view text) {
  uint64_t seed = 0;
  if (absl::SimpleAtoi(text, &seed)) return seed;
  return Expected("a whole number from 0 to 18446744073709551615", text);
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
  const std::optional<motion::Vec3> direction = ParsePoint(text);
  if (direction.has_value()) return *direction;
  return Expected("X,Y,Z such as 1,0,0", text);
}

void SortByClass(std::vector<ClassWeight>* labels) {
  std::sort(labels->begin(), labels->end(), [](const ClassWeight& a, const ClassWeight& b) {
    return a.interaction_class < b.interaction_class;
  });
}

std::string WeightText(float weight) {
  std::string text;
  base::AppendNumber(&text, weight);
  return text;
}

}  // namespace duet::client::batch
