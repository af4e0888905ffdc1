#include "model/training/options.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"
#include "model/checkpoint/architecture_json.h"
#include "model/checkpoint/names.h"
#include "model/retargeting/anatomy.h"
#include "model/training/setting_fields.h"

namespace duet::training {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 4;

void DeclareOptimiser(SettingFields* fields, TrainingOptions::Optimiser* optimiser) {
  fields->Word("name", {"adam", "rmsprop"}, &optimiser->name);
  fields->Number("learning_rate", 1e-9, 10, &optimiser->learning_rate);
  fields->Word("schedule", {"one_cycle", "constant", "cosine"}, &optimiser->schedule);
  if (optimiser->schedule == "cosine") {
    fields->Int("warm_up_steps", 0, kMaxEpochs, &optimiser->warm_up_steps);
    fields->Share("last_share", &optimiser->last_share);
    fields->Number("second_moment", 0, 0.999999, &optimiser->second_moment);
  }
  fields->Number("weight_decay", 0, 10, &optimiser->weight_decay);
  fields->Number("gradient_clip", 0, 1e9, &optimiser->gradient_clip);
  fields->Number("average_decay", 0, 0.999999, &optimiser->average_decay);
}

void DeclareAugmentation(SettingFields* fields, TrainingOptions::Augmentation* augmentation) {
  fields->Share("mirror", &augmentation->mirror);
  fields->Share("mirror_handed", &augmentation->mirror_handed);
  fields->Share("swap_roles", &augmentation->swap_roles);
  fields->Number("body_scale", 0, 0.9, &augmentation->body_scale);
  fields->Number("time_warp", 0, 2, &augmentation->time_warp);
  fields->Number("root_distance", 0, 10, &augmentation->root_distance);
  fields->Number("yaw", 0, 4, &augmentation->yaw);
  fields->Number("leader_yaw", 0, 4, &augmentation->leader_yaw);
  fields->Number("noise", 0, 10, &augmentation->noise);
  fields->Number("body_noise", 0, 10, &augmentation->body_noise);
  fields->Share("crop", &augmentation->crop);
}

// Declares every setting that does not depend on the method.
void Declare(SettingFields* fields, TrainingOptions* options) {
  fields->Section("optimiser", [&] { DeclareOptimiser(fields, &options->optimiser); });
  fields->Int("epochs", 1, kMaxEpochs, &options->epochs);
  fields->Int("batch", 1, 65536, &options->batch);
  int64_t seed = static_cast<int64_t>(options->seed);
  fields->Int("seed", 0, INT64_MAX, &seed);
  options->seed = static_cast<uint64_t>(seed);
  fields->Section("augmentation", [&] { DeclareAugmentation(fields, &options->augmentation); });
  fields->Section("start", [&, &start = options->start] {
    fields->Share("root", &start.root);
    fields->Share("pose", &start.pose);
  });
  fields->Section("validation", [&, &validation = options->validation] {
    fields->Words("subjects", &validation.subjects);
    fields->Number("fraction", 0, 0.9, &validation.fraction);
    fields->Int("patience", 0, kMaxEpochs, &validation.patience);
  });
}

// The settings that train each architecture.
Method MethodFor(const checkpoint::PaperArchitecture& architecture) {
  PaperTraining method;
  method.architecture = architecture;
  return method;
}
Method MethodFor(const checkpoint::FlowArchitecture& architecture) {
  FlowTraining method;
  method.architecture = architecture;
  return method;
}

Method ReadMethod(base::ObjectReader* root, SettingFields* fields) {
  checkpoint::Architecture architecture;
  const json& object = root->Object("generator");
  if (root->ok()) {
    base::ObjectReader generator(object, "generator");
    architecture =
        checkpoint::ReadArchitecture(generator.Has(checkpoint::kArchitectureKind), &generator);
    root->Update(generator.Finish());
  }
  Method method = std::visit([](const auto& one) { return MethodFor(one); }, architecture);
  if (root->ok()) std::visit([fields](auto& one) { Declare(fields, &one); }, method);
  return method;
}

absl::StatusOr<TrainingOptions> ReadOptions(const json& value) {
  base::ObjectReader root(value, "");
  SettingFields fields(&root);
  TrainingOptions options;
  options.method = ReadMethod(&root, &fields);
  options.standardisation = ReadNamed(&root, "standardisation", checkpoint::kStandardisationNames);
  Declare(&fields, &options);
  if (absl::Status status = root.Finish(); !status.ok()) return status;
  const TrainingOptions::Start& start = options.start;
  if (start.root + start.pose <= 1) return options;
  return absl::InvalidArgumentError(absl::StrCat("start.pose: expected at most ", 1 - start.root,
                                                 ", got ", start.pose,
                                                 ": root and pose are shares of all clips"));
}

// A replacement's value: parsed as JSON if possible, else the text itself.
json ParseValue(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

absl::Status Replace(const std::string& path, const std::string& text, json* root) {
  json* at = root;
  for (const std::string& key : std::vector<std::string>(absl::StrSplit(path, '.'))) {
    if (!at->is_object() || !at->contains(key)) {
      return absl::InvalidArgumentError(absl::StrCat(path, ": no such setting"));
    }
    at = &(*at)[key];
  }
  *at = ParseValue(text);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<TrainingOptions> ParseTrainingOptions(std::string_view text) {
  return ParseTrainingOptions(text, {});
}

absl::StatusOr<TrainingOptions> ParseTrainingOptions(
    std::string_view text, const std::vector<std::pair<std::string, std::string>>& replacements) {
  absl::StatusOr<json> root = base::ParseStrictJson(text, kMaxDepth);
  if (!root.ok()) return root.status();
  for (const auto& [path, value] : replacements) {
    absl::Status status = Replace(path, value, &*root);
    if (!status.ok()) return status;
  }
  return ReadOptions(*root);
}

checkpoint::Architecture ArchitectureOf(const TrainingOptions& options) {
  return std::visit([](const auto& one) -> checkpoint::Architecture { return one.architecture; },
                    options.method);
}

std::map<std::string, std::string> Describe(const TrainingOptions& options) {
  TrainingOptions declared = options;
  Description description;
  SettingFields fields(&description);
  Declare(&fields, &declared);
  std::visit([&fields](auto& one) { Declare(&fields, &one); }, declared.method);
  description["standardisation"] =
      std::string(NameOf(checkpoint::kStandardisationNames, options.standardisation));
  return description;
}

namespace {

// A mirror image is wrong if left and right joints are not exchanged.
absl::Status CheckMirror(const TrainingOptions::Augmentation& augmentation,
                         const motion::Skeleton& skeleton) {
  if (augmentation.mirror == 0 && augmentation.mirror_handed == 0) return absl::OkStatus();
  const std::vector<int> counterparts = retargeting::CounterpartJoints(skeleton.joint_names);
  for (size_t joint = 0; joint < counterparts.size(); ++joint) {
    if (counterparts[joint] != static_cast<int>(joint)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("augmentation.mirror: ", augmentation.mirror,
                   ", but no joint's name says left or right; expected names such as left_hand and "
                   "right_hand, or "
                   "augmentation.mirror=0"));
}

}  // namespace

absl::Status CheckAgainst(const TrainingOptions& options, const dataset::Dataset& dataset) {
  if (absl::Status status = CheckMirror(options.augmentation, dataset.skeleton); !status.ok()) {
    return status;
  }
  const std::vector<std::string> subjects = dataset.Subjects();
  for (const std::string& name : options.validation.subjects) {
    if (std::find(subjects.begin(), subjects.end(), name) != subjects.end()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("validation.subjects: expected subjects of the data (",
                     subjects.empty() ? "it names none" : absl::StrJoin(subjects, ", "), "), got ",
                     base::Quoted(name)));
  }
  return absl::OkStatus();
}

}  // namespace duet::training
