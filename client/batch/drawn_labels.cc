#include "client/batch/drawn_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/batch/leaders.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {
namespace {

// Drawn weights are multiples of 1 / kWeightsInOne, so that they have few decimals.
constexpr double kWeightsInOne = 1000;

float DrawWeight(const WeightRange& range, base::Random* random) {
  const double weight = random->Uniform(range.min, range.max);
  return static_cast<float>(std::round(weight * kWeightsInOne) / kWeightsInOne);
}

std::vector<DrawnLabels> DrawMixes(const std::string& name, const v1::Mixes& mixes,
                                   const std::vector<std::string>& all, base::Random* random) {
  std::vector<DrawnLabels> drawn;
  for (uint32_t i = 0; i < mixes.count(); ++i) {
    std::vector<std::string> classes = all;
    random->Shuffle(&classes);
    drawn.push_back({absl::StrCat(name.empty() ? "mix" : name, i), {}});
    for (uint32_t c = 0; c < ClassesInMix(mixes); ++c) {
      drawn.back().labels.push_back({classes[c], DrawWeight(RangeOf(mixes), random)});
    }
  }
  return drawn;
}

std::vector<DrawnLabels> DrawEachClass(const std::string& name, const v1::EachClass& each,
                                       const std::vector<std::string>& classes,
                                       base::Random* random) {
  std::vector<DrawnLabels> drawn;
  for (size_t c = 0; c < classes.size(); ++c) {
    drawn.push_back({absl::StrCat(name.empty() ? "each" : name, "_", PlainName(classes[c])),
                     {{classes[c], DrawWeight(RangeOf(each), random)}}});
    if (!each.has_beside()) continue;
    // Any other class.
    auto other = static_cast<size_t>(random->Below(static_cast<int64_t>(classes.size()) - 1));
    if (other >= c) ++other;
    const WeightRange beside{each.beside().min_weight(), each.beside().max_weight()};
    drawn.back().labels.push_back({classes[other], DrawWeight(beside, random)});
  }
  return drawn;
}

}  // namespace

WeightRange RangeOf(const v1::Mixes& mixes) {
  return {mixes.has_min_weight() ? mixes.min_weight() : 0.25f,
          mixes.has_max_weight() ? mixes.max_weight() : 1};
}

WeightRange RangeOf(const v1::EachClass& each) {
  return {each.has_min_weight() ? each.min_weight() : 1,
          each.has_max_weight() ? each.max_weight() : 1};
}

uint32_t ClassesInMix(const v1::Mixes& mixes) {
  return mixes.has_classes_in_mix() ? mixes.classes_in_mix() : 2;
}

bool IsDrawn(const v1::Reaction& reaction) {
  const WeightRange range = RangeOf(reaction.each_class());
  return reaction.has_mixes() || (reaction.has_each_class() &&
                                  (reaction.each_class().has_beside() || range.min != range.max));
}

std::vector<std::string> ClassesOf(const v1::Reaction& reaction) {
  const auto& classes =
      reaction.has_mixes() ? reaction.mixes().classes() : reaction.each_class().classes();
  return {classes.begin(), classes.end()};
}

absl::Status CheckDrawn(const v1::Reaction& reaction, const std::vector<std::string>& classes) {
  const size_t wanted = reaction.has_mixes()                 ? ClassesInMix(reaction.mixes())
                        : reaction.each_class().has_beside() ? 2
                                                             : 1;
  if (wanted <= classes.size()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("reactions: classes in a label vector: expected at most the ", classes.size(),
                   " classes, got ", wanted));
}

std::vector<DrawnLabels> Draw(const v1::Reaction& reaction, const std::vector<std::string>& classes,
                              base::Random* random) {
  std::vector<DrawnLabels> drawn =
      reaction.has_mixes() ? DrawMixes(reaction.name(), reaction.mixes(), classes, random)
                           : DrawEachClass(reaction.name(), reaction.each_class(), classes, random);
  for (DrawnLabels& one : drawn) SortByClass(&one.labels);
  return drawn;
}

std::string PlainName(const std::string& name) {
  return absl::StrReplaceAll(KeyOf(name), {{"/", "_"}, {"-", "_"}, {"+", "_"}});
}

}  // namespace duet::client::batch
