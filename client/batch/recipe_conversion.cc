#include "client/batch/recipe_conversion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/batch/capture_layout.h"
#include "client/batch/level.h"
#include "client/batch/text_values.h"
#include "model/base/printable.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::client::batch {
namespace {

constexpr float kMaxAbsWeight = 2;
constexpr uint32_t kMaxSamples = 10'000;
constexpr uint32_t kMaxMixes = 10'000;
constexpr uint32_t kMaxRetries = 100;
constexpr uint32_t kMaxCandidates = 16;
constexpr size_t kMaxGrid = 100'000;

// Of the names in a message.
constexpr size_t kLongestField = 200, kLongestValue = 200;

// Stores the first error.
class Checker {
 public:
  void Expect(bool good, const std::string& field, const std::string& got, const char* expected) {
    if (good || !status_.ok()) return;
    status_ = absl::InvalidArgumentError(absl::StrCat(base::Printable(field, kLongestField),
                                                      ": expected ", expected, ", got ",
                                                      base::Printable(got, kLongestValue)));
  }
  void Weight(const std::string& field, float weight) {
    Expect(std::abs(weight) <= kMaxAbsWeight, field, absl::StrCat(weight), "a number from -2 to 2");
  }
  void Count(const std::string& field, uint32_t value, uint32_t low, uint32_t high) {
    Expect(value >= low && value <= high, field, absl::StrCat(value),
           absl::StrCat("a number from ", low, " to ", high).c_str());
  }
  template <typename Range>
  void Different(const std::string& field, const Range& values) {
    std::set<typename Range::value_type> seen;
    for (const auto& value : values) {
      Expect(seen.insert(value).second, field, absl::StrCat(value, " twice"), "each once");
    }
  }
  const absl::Status& status() const { return status_; }

 private:
  absl::Status status_;
};

Labels ReadLabels(const v1::Labels& proto, const std::string& field, Checker* check) {
  check->Expect(proto.weights_size() > 0, field + ".weights", "none", "one or more");
  Labels labels;
  for (const auto& [name, weight] : proto.weights()) {
    check->Expect(!name.empty(), field + ".weights", "an empty name", "a class");
    check->Weight(absl::StrCat(field, ".weights[", name, "]"), weight);
    labels.push_back({name, weight});
  }
  SortByClass(&labels);
  return labels;
}

std::vector<std::string> ReadClasses(const google::protobuf::RepeatedPtrField<std::string>& proto,
                                     const std::string& field, Checker* check) {
  std::vector<std::string> classes(proto.begin(), proto.end());
  check->Different(field, classes);
  return classes;
}

Grid ReadGrid(const v1::Grid& proto, const std::string& field, Checker* check) {
  Grid grid;
  std::vector<std::string> names;
  size_t size = 1;
  check->Expect(proto.axes_size() > 0, field + ".axes", "none", "one or more");
  for (int i = 0; i < proto.axes_size(); ++i) {
    const v1::Grid::Axis& axis = proto.axes(i);
    const std::string at = absl::StrCat(field, ".axes[", i, "]");
    check->Expect(!axis.interaction_class().empty(), at + ".interaction_class", "none", "a class");
    check->Expect(axis.weights_size() > 0, at + ".weights", "none", "one or more");
    for (const float weight : axis.weights()) check->Weight(at + ".weights", weight);
    check->Different(at + ".weights", axis.weights());
    names.push_back(axis.interaction_class());
    grid.axes.push_back({axis.interaction_class(), {axis.weights().begin(), axis.weights().end()}});
    size = std::min(kMaxGrid + 1, size * static_cast<size_t>(std::max(1, axis.weights_size())));
  }
  check->Different(field + ".axes", names);
  check->Expect(size <= kMaxGrid, field, "more combinations", "at most 100000");
  return grid;
}

WeightRange ReadRange(float min, float max, const std::string& field, Checker* check) {
  check->Weight(field + ".min_weight", min);
  check->Weight(field + ".max_weight", max);
  check->Expect(min <= max, field + ".min_weight", absl::StrCat(min), "at most max_weight");
  return {min, max};
}

Mixes ReadMixes(const v1::Mixes& proto, const std::string& field, Checker* check) {
  Mixes mixes;
  check->Count(field + ".count", proto.count(), 1, kMaxMixes);
  mixes.count = static_cast<int>(proto.count());
  mixes.classes = ReadClasses(proto.classes(), field + ".classes", check);
  if (proto.has_classes_in_mix()) {
    check->Count(field + ".classes_in_mix", proto.classes_in_mix(), 1, 1000);
    mixes.classes_in_mix = static_cast<int>(proto.classes_in_mix());
  }
  check->Expect(
      mixes.classes.empty() || static_cast<size_t>(mixes.classes_in_mix) <= mixes.classes.size(),
      field + ".classes_in_mix", absl::StrCat(mixes.classes_in_mix),
      "no more than there are classes");
  mixes.weight =
      ReadRange(proto.has_min_weight() ? proto.min_weight() : mixes.weight.min,
                proto.has_max_weight() ? proto.max_weight() : mixes.weight.max, field, check);
  return mixes;
}

EachClass ReadEachClass(const v1::EachClass& proto, const std::string& field, Checker* check) {
  EachClass each;
  each.classes = ReadClasses(proto.classes(), field + ".classes", check);
  each.weight =
      ReadRange(proto.has_min_weight() ? proto.min_weight() : each.weight.min,
                proto.has_max_weight() ? proto.max_weight() : each.weight.max, field, check);
  if (!proto.has_beside()) return each;
  each.beside =
      ReadRange(proto.beside().min_weight(), proto.beside().max_weight(), field + ".beside", check);
  check->Expect(each.classes.size() != 1, field + ".classes", "one", "two or more with beside");
  return each;
}

Schedule ReadSchedule(const v1::Schedule& proto, const std::string& field, Checker* check) {
  Schedule schedule;
  check->Expect(proto.keyframes_size() > 0, field + ".keyframes", "none", "one or more");
  double last = -1;
  for (int i = 0; i < proto.keyframes_size(); ++i) {
    const v1::Schedule::Keyframe& keyframe = proto.keyframes(i);
    const std::string at = absl::StrCat(field, ".keyframes[", i, "]");
    check->Expect(keyframe.at() >= 0 && keyframe.at() <= 1 && keyframe.at() > last, at + ".at",
                  absl::StrCat(keyframe.at()), "0 to 1, rising");
    last = keyframe.at();
    schedule.keyframes.push_back({keyframe.at(), ReadLabels(keyframe.labels(), at, check)});
  }
  return schedule;
}

bool IsName(const std::string& name) {
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return absl::ascii_isalnum(c) || c == '_'; });
}

Reaction ReadReaction(const v1::Reaction& proto, const std::string& field, Checker* check) {
  Reaction reaction;
  reaction.name = proto.name();
  check->Expect(IsName(proto.name()), field + ".name", base::Quoted(proto.name()),
                "letters, digits and underscores");
  switch (proto.kind_case()) {
    case v1::Reaction::kLabels:
      reaction.kind = ReadLabels(proto.labels(), field + ".labels", check);
      break;
    case v1::Reaction::kGrid:
      reaction.kind = ReadGrid(proto.grid(), field + ".grid", check);
      break;
    case v1::Reaction::kMixes:
      reaction.kind = ReadMixes(proto.mixes(), field + ".mixes", check);
      break;
    case v1::Reaction::kEachClass:
      reaction.kind = ReadEachClass(proto.each_class(), field + ".each_class", check);
      break;
    case v1::Reaction::kSchedule:
      reaction.kind = ReadSchedule(proto.schedule(), field + ".schedule", check);
      break;
    case v1::Reaction::KIND_NOT_SET:
      check->Expect(false, field, "nothing", "one of labels, grid, mixes, each_class and schedule");
  }
  return reaction;
}

LeaderInput ReadInput(const v1::LeaderInput& proto, Checker* check) {
  LeaderInput input;
  check->Expect(v1::Side_IsValid(proto.side()), "input.side", absl::StrCat(proto.side()), "a side");
  if (proto.side() == v1::SIDE_LEFT) input.side = Sides::kLeft;
  if (proto.side() == v1::SIDE_RIGHT) input.side = Sides::kRight;
  if (proto.side() == v1::SIDE_BOTH) input.side = Sides::kBoth;
  input.starts_as_other_person = proto.follower_start() == v1::FOLLOWER_START_OTHER_PERSON;
  if (proto.has_frame_rate_hz()) input.frame_rate_hz = proto.frame_rate_hz();
  if (proto.has_metres_per_unit()) input.metres_per_unit = proto.metres_per_unit();
  check->Expect(input.frame_rate_hz.value_or(1) > 0, "input.frame_rate_hz",
                absl::StrCat(proto.frame_rate_hz()), "more than 0");
  check->Expect(input.metres_per_unit.value_or(1) > 0, "input.metres_per_unit",
                absl::StrCat(proto.metres_per_unit()), "more than 0");
  if (proto.has_unit()) {
    input.unit = motion::ParseLengthUnit(proto.unit());
    check->Expect(input.unit.has_value(), "input.unit", base::Quoted(proto.unit()),
                  motion::kLengthUnitNames);
  }
  if (proto.has_up_axis()) {
    input.up_axis = motion::ParseUpAxis(proto.up_axis());
    check->Expect(input.up_axis.has_value(), "input.up_axis", base::Quoted(proto.up_axis()),
                  motion::kUpAxisNames);
  }
  if (proto.has_format()) {
    input.format = formats::ParseFormat(proto.format());
    check->Expect(input.format.has_value(), "input.format", base::Quoted(proto.format()),
                  formats::kReadableFormatNames);
  }
  if (proto.has_level()) {
    const absl::StatusOr<Level> level = ParseLevel(proto.level());
    check->Expect(level.ok(), "input.level", base::Quoted(proto.level()),
                  "auto, off or X,Y,Z less than 45 degrees from 0,1,0");
    if (level.ok()) input.level = *level;
  }
  input.up = input.level.up;
  input.joint_map.insert(proto.joint_map().begin(), proto.joint_map().end());
  return input;
}

QualityFilter ReadFilter(const v1::QualityFilter& proto, Checker* check) {
  QualityFilter filter;
  const auto read = [check](const char* name, bool has, double value,
                            std::optional<double>* limit) {
    if (!has) return;
    check->Expect(value >= 0, absl::StrCat("filter.", name), absl::StrCat(value), "0 or more");
    *limit = value;
  };
  read("max_lean_degrees", proto.has_max_lean_degrees(), proto.max_lean_degrees(),
       &filter.max_lean_degrees);
  read("max_foot_above_floor_metres", proto.has_max_foot_above_floor_metres(),
       proto.max_foot_above_floor_metres(), &filter.max_foot_above_floor_metres);
  read("max_foot_below_floor_metres", proto.has_max_foot_below_floor_metres(),
       proto.max_foot_below_floor_metres(), &filter.max_foot_below_floor_metres);
  read("min_distance_metres", proto.has_min_distance_metres(), proto.min_distance_metres(),
       &filter.min_distance_metres);
  read("max_distance_metres", proto.has_max_distance_metres(), proto.max_distance_metres(),
       &filter.max_distance_metres);
  read("max_penetration_metres", proto.has_max_penetration_metres(), proto.max_penetration_metres(),
       &filter.max_penetration_metres);
  read("min_range_of_motion_metres", proto.has_min_range_of_motion_metres(),
       proto.min_range_of_motion_metres(), &filter.min_range_of_motion_metres);
  read("max_unfamiliarity", proto.has_max_unfamiliarity(), proto.max_unfamiliarity(),
       &filter.max_unfamiliarity);
  read("max_twisted", proto.has_max_twisted(), proto.max_twisted(), &filter.max_twisted);
  read("max_overlapping", proto.has_max_overlapping(), proto.max_overlapping(),
       &filter.max_overlapping);
  read("max_skating_over_leader", proto.has_max_skating_over_leader(),
       proto.max_skating_over_leader(), &filter.max_skating_over_leader);
  if (proto.has_classifier()) {
    const double probability = proto.classifier().min_probability();
    check->Expect(probability > 0 && probability <= 1, "filter.classifier.min_probability",
                  absl::StrCat(probability), "above 0, at most 1");
    check->Expect(!proto.classifier().model().empty(), "filter.classifier.model", "none",
                  "the folder of a judge (duet-eval judge)");
    filter.min_class_probability = probability;
  }
  check->Count("filter.retries_per_item", proto.retries_per_item(), 0, kMaxRetries);
  filter.retries_per_item = static_cast<int>(proto.retries_per_item());
  return filter;
}

Layout ToLayout(v1::Layout layout) {
  switch (layout) {
    case v1::LAYOUT_CLASS_FOLDERS:
      return Layout::kClassFolders;
    case v1::LAYOUT_SBU:
      return Layout::kSbu;
    case v1::LAYOUT_K3HI:
      return Layout::kK3hi;
    default:
      return Layout::kMirror;
  }
}

Output ReadOutput(const v1::Output& proto, Checker* check) {
  Output output;
  check->Expect(v1::Layout_IsValid(proto.layout()), "output.layout", absl::StrCat(proto.layout()),
                "a layout");
  output.layout = ToLayout(proto.layout());
  const bool own_format = CapturesOf(output.layout) != nullptr;
  check->Expect(own_format || proto.formats_size() > 0, "output.formats", "none", "one or more");
  check->Expect(!own_format || proto.formats_size() == 0, "output.formats", "some",
                "none: the layout has its own");
  for (const int format : proto.formats()) {
    check->Expect(v1::Format_IsValid(format) && format != v1::FORMAT_UNSPECIFIED, "output.formats",
                  absl::StrCat(format),
                  "FORMAT_BVH, FORMAT_CSV, FORMAT_NPY, FORMAT_JSON or FORMAT_GLB");
    // The enums have the same order; the proto's begins at 1.
    output.formats.push_back(static_cast<Format>(format - v1::FORMAT_BVH));
  }
  check->Different("output.formats", proto.formats());
  if (proto.has_frame_rate_hz()) output.frame_rate_hz = proto.frame_rate_hz();
  check->Expect(!own_format || !output.frame_rate_hz, "output.frame_rate_hz", "one",
                "none: the layout has a rate of its own");
  check->Expect(output.frame_rate_hz.value_or(1) > 0 &&
                    output.frame_rate_hz.value_or(1) <= motion::kMaxFrameRateHz,
                "output.frame_rate_hz", absl::StrCat(proto.frame_rate_hz()),
                "above 0, at most 1000");
  return output;
}

void ReadModels(const v1::Recipe& proto, Checker* check, Recipe* recipe) {
  check->Different("models", proto.models());
  for (const std::string& name : proto.models()) {
    const absl::StatusOr<ModelChoice> choice = ParseModelChoice(name);
    check->Expect(choice.ok(), "models", base::Quoted(name), "NAME, NAME@VERSION or NAME:LABEL");
    if (choice.ok()) recipe->models.push_back(*choice);
  }
  if (recipe->models.empty()) recipe->models.emplace_back();
}

}  // namespace

absl::StatusOr<Recipe> FromProto(const v1::Recipe& proto) {
  Checker check;
  Recipe recipe;
  recipe.seed = proto.seed();
  ReadModels(proto, &check, &recipe);
  for (int i = 0; i < proto.reactions_size(); ++i) {
    recipe.reactions.push_back(
        ReadReaction(proto.reactions(i), absl::StrCat("reactions[", i, "]"), &check));
  }
  if (proto.has_samples()) {
    check.Count("samples", proto.samples(), 1, kMaxSamples);
    recipe.samples = static_cast<int>(proto.samples());
  }
  if (proto.has_variety()) recipe.variety = proto.variety();
  check.Expect(recipe.variety >= 0 && recipe.variety <= 2, "variety", absl::StrCat(recipe.variety),
               "a number from 0 to 2");
  if (proto.has_candidates()) {
    check.Count("candidates", proto.candidates(), 1, kMaxCandidates);
    recipe.candidates = static_cast<int>(proto.candidates());
  }
  recipe.input = ReadInput(proto.input(), &check);
  recipe.filter = ReadFilter(proto.filter(), &check);
  recipe.output = ReadOutput(proto.output(), &check);
  if (!check.status().ok()) return check.status();
  return recipe;
}

}  // namespace duet::client::batch
