#include "client/batch/drawn_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/batch/leader_entry.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {
namespace {

// Drawn weights are multiples of 1 / kWeightsInOne, so that they have few decimals.
constexpr double kWeightsInOne = 1000;

float DrawWeight(const WeightRange& range, base::Random* random) {
  const double weight = random->Uniform(range.min, range.max);
  return static_cast<float>(std::round(weight * kWeightsInOne) / kWeightsInOne);
}

std::vector<DrawnLabels> DrawMixes(const std::string& name, const Mixes& mixes,
                                   const std::vector<std::string>& all, base::Random* random) {
  std::vector<DrawnLabels> drawn;
  for (int i = 0; i < mixes.count; ++i) {
    std::vector<std::string> classes = all;
    random->Shuffle(&classes);
    drawn.push_back({absl::StrCat(name.empty() ? "mix" : name, i), {}});
    for (int c = 0; c < mixes.classes_in_mix; ++c) {
      drawn.back().labels.push_back(
          {classes[static_cast<size_t>(c)], DrawWeight(mixes.weight, random)});
    }
  }
  return drawn;
}

std::vector<DrawnLabels> DrawEachClass(const std::string& name, const EachClass& each,
                                       const std::vector<std::string>& classes,
                                       base::Random* random) {
  std::vector<DrawnLabels> drawn;
  for (size_t c = 0; c < classes.size(); ++c) {
    drawn.push_back({absl::StrCat(name.empty() ? "each" : name, "_", PlainName(classes[c])),
                     {{classes[c], DrawWeight(each.weight, random)}}});
    if (!each.beside.has_value()) continue;
    // Any other class.
    auto other = static_cast<size_t>(random->Below(static_cast<int64_t>(classes.size()) - 1));
    if (other >= c) ++other;
    drawn.back().labels.push_back({classes[other], DrawWeight(*each.beside, random)});
  }
  return drawn;
}

}  // namespace

bool IsDrawn(const Reaction& reaction) {
  if (std::holds_alternative<Mixes>(reaction.kind)) return true;
  const auto* each = std::get_if<EachClass>(&reaction.kind);
  return each != nullptr && (each->beside.has_value() || each->weight.min != each->weight.max);
}

const std::vector<std::string>& ClassesOf(const Reaction& reaction) {
  const auto* mixes = std::get_if<Mixes>(&reaction.kind);
  return mixes != nullptr ? mixes->classes : std::get<EachClass>(reaction.kind).classes;
}

absl::Status CheckDrawn(const Reaction& reaction, const std::vector<std::string>& classes) {
  const auto* mixes = std::get_if<Mixes>(&reaction.kind);
  const size_t wanted = mixes != nullptr ? static_cast<size_t>(mixes->classes_in_mix)
                        : std::get<EachClass>(reaction.kind).beside ? 2
                                                                    : 1;
  if (wanted <= classes.size()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("reactions: classes in a label vector: expected at most the ", classes.size(),
                   " classes, got ", wanted));
}

std::vector<DrawnLabels> Draw(const Reaction& reaction, const std::vector<std::string>& classes,
                              base::Random* random) {
  const auto* mixes = std::get_if<Mixes>(&reaction.kind);
  std::vector<DrawnLabels> drawn =
      mixes != nullptr
          ? DrawMixes(reaction.name, *mixes, classes, random)
          : DrawEachClass(reaction.name, std::get<EachClass>(reaction.kind), classes, random);
  for (DrawnLabels& one : drawn) SortByClass(&one.labels);
  return drawn;
}

std::string PlainName(const std::string& name) {
  return absl::StrReplaceAll(KeyOf(name), {{"/", "_"}, {"-", "_"}, {"+", "_"}});
}

}  // namespace duet::client::batch
