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

void Read(base::ObjectReader* reader, TrainingOptions::Optimiser* out) {
  out->name = OneOf(reader, "name", {"adam", "rmsprop"});
  out->learning_rate = reader->Number("learning_rate", 1e-9, 10);
  out->schedule = OneOf(reader, "schedule", {"one_cycle", "constant", "cosine"});
  if (out->schedule == "cosine") {
    out->warm_up_steps = reader->Int("warm_up_steps", 0, kMaxEpochs);
    out->last_share = Probability(reader, "last_share");
    out->second_moment = reader->Number("second_moment", 0, 0.999999);
  }
  out->weight_decay = reader->Number("weight_decay", 0, 10);
  out->gradient_clip = reader->Number("gradient_clip", 0, 1e9);
  out->average_decay = reader->Number("average_decay", 0, 0.999999);
}

void Read(base::ObjectReader* reader, TrainingOptions::Augmentation* out) {
  out->mirror = Probability(reader, "mirror");
  out->mirror_handed = Probability(reader, "mirror_handed");
  out->swap_roles = Probability(reader, "swap_roles");
  out->body_scale = reader->Number("body_scale", 0, 0.9);
  out->time_warp = reader->Number("time_warp", 0, 2);
  out->root_distance = reader->Number("root_distance", 0, 10);
  out->yaw = reader->Number("yaw", 0, 4);
  out->leader_yaw = reader->Number("leader_yaw", 0, 4);
  out->noise = reader->Number("noise", 0, 10);
  out->body_noise = reader->Number("body_noise", 0, 10);
  out->crop = Probability(reader, "crop");
}

void Read(base::ObjectReader* reader, TrainingOptions::Start* out) {
  out->root = Probability(reader, "root");
  out->pose = Probability(reader, "pose");
  if (reader->ok() && out->root + out->pose > 1) {
    reader->Fail("pose", absl::StrCat("expected at most ", 1 - out->root, ", got ", out->pose,
                                      ": root and pose are shares of all clips"));
  }
}

void Read(base::ObjectReader* reader, TrainingOptions::Validation* out) {
  out->subjects = reader->Strings("subjects", 256);
  out->fraction = reader->Number("fraction", 0, 0.9);
  out->patience = reader->Int("patience", 0, kMaxEpochs);
}

// The settings that train each architecture.
PaperTraining MethodFor(const checkpoint::PaperArchitecture& architecture) {
  PaperTraining method;
  method.architecture = architecture;
  return method;
}
FlowTraining MethodFor(const checkpoint::FlowArchitecture& architecture) {
  FlowTraining method;
  method.architecture = architecture;
  return method;
}

Method ReadMethod(base::ObjectReader* root) {
  checkpoint::Architecture architecture;
  ReadSection(root, "generator", &architecture,
              [](base::ObjectReader* reader, checkpoint::Architecture* out) {
                *out = checkpoint::ReadArchitecture(reader->Has(checkpoint::kArchitectureKind),
                                                    reader);
              });
  Method method =
      std::visit([](const auto& one) -> Method { return MethodFor(one); }, architecture);
  if (root->ok()) std::visit([root](auto& one) { ReadSections(root, &one); }, method);
  return method;
}

absl::StatusOr<TrainingOptions> ReadOptions(const json& value) {
  base::ObjectReader root(value, "");
  TrainingOptions options;
  const auto section = [&root](const char* name, auto* settings) {
    ReadSection(&root, name, settings,
                [](base::ObjectReader* reader, auto* fields) { Read(reader, fields); });
  };
  options.method = ReadMethod(&root);
  options.standardisation = ReadNamed(&root, "standardisation", checkpoint::kStandardisationNames);
  section("optimiser", &options.optimiser);
  options.epochs = root.Int("epochs", 1, kMaxEpochs);
  options.batch = root.Int("batch", 1, 65536);
  options.seed = static_cast<uint64_t>(root.Int("seed", 0, INT64_MAX));
  section("augmentation", &options.augmentation);
  section("start", &options.start);
  section("validation", &options.validation);
  if (absl::Status status = root.Finish(); !status.ok()) return status;
  return options;
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

namespace {

void DescribeCosine(const TrainingOptions::Optimiser& o, Description* out) {
  out->insert({{"optimiser.warm_up_steps", Text(o.warm_up_steps)},
               {"optimiser.last_share", Text(o.last_share)},
               {"optimiser.second_moment", Text(o.second_moment)}});
}

}  // namespace

std::map<std::string, std::string> Describe(const TrainingOptions& o) {
  Description description = {
      {"standardisation",
       std::string(NameOf(checkpoint::kStandardisationNames, o.standardisation))},
      {"optimiser.name", o.optimiser.name},
      {"optimiser.learning_rate", Text(o.optimiser.learning_rate)},
      {"optimiser.schedule", o.optimiser.schedule},
      {"optimiser.weight_decay", Text(o.optimiser.weight_decay)},
      {"optimiser.gradient_clip", Text(o.optimiser.gradient_clip)},
      {"optimiser.average_decay", Text(o.optimiser.average_decay)},
      {"epochs", absl::StrCat(o.epochs)},
      {"batch", absl::StrCat(o.batch)},
      {"seed", absl::StrCat(o.seed)},
      {"augmentation.mirror", Text(o.augmentation.mirror)},
      {"augmentation.mirror_handed", Text(o.augmentation.mirror_handed)},
      {"augmentation.swap_roles", Text(o.augmentation.swap_roles)},
      {"augmentation.body_scale", Text(o.augmentation.body_scale)},
      {"augmentation.time_warp", Text(o.augmentation.time_warp)},
      {"augmentation.root_distance", Text(o.augmentation.root_distance)},
      {"augmentation.yaw", Text(o.augmentation.yaw)},
      {"augmentation.leader_yaw", Text(o.augmentation.leader_yaw)},
      {"augmentation.noise", Text(o.augmentation.noise)},
      {"augmentation.body_noise", Text(o.augmentation.body_noise)},
      {"augmentation.crop", Text(o.augmentation.crop)},
      {"start.root", Text(o.start.root)},
      {"start.pose", Text(o.start.pose)},
      {"validation.subjects", absl::StrJoin(o.validation.subjects, " ")},
      {"validation.fraction", Text(o.validation.fraction)},
      {"validation.patience", absl::StrCat(o.validation.patience)}};
  if (o.optimiser.schedule == "cosine") DescribeCosine(o.optimiser, &description);
  std::visit([&description](const auto& one) { Describe(one, &description); }, o.method);
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
