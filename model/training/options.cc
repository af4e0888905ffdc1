#include "model/training/options.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/status_macros.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/checkpoint/architecture_json.h"
#include "model/retargeting/anatomy.h"
#include "model/training/named_configs.inc"

namespace duet::training {
namespace {

using checkpoint::Fields;
using nlohmann::json;

using Replacements = std::vector<std::pair<std::string, std::string>>;

constexpr std::size_t kMaxNameBytes = 64;
constexpr int64_t kMaxUnits = 4096;
constexpr int64_t kMaxEpochs = 1000000;
constexpr double kMaxWeight = 1e6;

constexpr int64_t kMostSteps = 100000000;

void Declare(Fields* fields, FlowTraining* flow) {
  fields->Section("flow", [&] {
    fields->Number("dropout", 0, 0.95, &flow->dropout);
    fields->Int("passes", 1, kMaxEpochs, &flow->passes);
    fields->Int("least_steps", 0, kMostSteps, &flow->least_steps);
    fields->Number("window_seconds", 0, 60, &flow->window_seconds);
    fields->Number("stride_seconds", 0.01, 60, &flow->stride_seconds);
    fields->Number("lookahead_seconds", 0, 60, &flow->lookahead_seconds);
    fields->Number("target_smoothing", 0, 100, &flow->target_smoothing);
    fields->Number("pair_scale", 0, 0.9, &flow->pair_scale);
    fields->Share("unlabelled", &flow->unlabelled);
    fields->Share("several_known", &flow->several_known);
    fields->Number("known_noise", 0, 10, &flow->known_noise);
    fields->Number("difference_weight", 0, kMaxWeight, &flow->difference_weight);
    fields->Number("bone_weight", 0, kMaxWeight, &flow->bone_weight);
    fields->Number("slide_speed", 0, 100, &flow->slide_speed);
    fields->Number("least_remaining", 1e-6, 1, &flow->least_remaining);
    fields->Number("noise_share", 0, 2, &flow->noise_share);
    if (fields->Has("class_balance")) fields->Share("class_balance", &flow->class_balance);
  });
  fields->Section("frame_labels", [&, &labels = flow->frame_labels] {
    fields->Number("shift", 0, 1000, &labels.shift);
    fields->Share("unlabelled", &labels.unlabelled);
    fields->Share("avoided", &labels.avoided);
  });
  fields->Section("drift", [&, &drift = flow->drift] {
    fields->Share("share", &drift.share);
    fields->Number("tilt", 0, 4, &drift.tilt);
    fields->Number("bend", 0, 4, &drift.bend);
    fields->Number("turn", 0, 4, &drift.turn);
    fields->Number("root", 0, 10, &drift.root);
    fields->Number("height", 0, 10, &drift.height);
    fields->Number("joints", 0, 10, &drift.joints);
    fields->Int("frames", 1, 1000, &drift.frames);
  });
  fields->Section("live", [&, &live = flow->live] {
    fields->Share("share", &live.share);
    fields->Share("several_known", &live.several_known);
    fields->Number("remade_seconds", 0, 60, &live.remade_seconds);
    fields->Number("delay_seconds", 0, 60, &live.delay_seconds);
    fields->Number("future_seconds", 0.1, 60, &live.future_seconds);
  });
  fields->Section("own", [&, &own = flow->own] {
    fields->Share("share", &own.share);
    fields->Int("most_frames", 1, 1000, &own.most_frames);
    fields->Int("return_frames", 1, 1000, &own.return_frames);
  });
  fields->Section("energy", [&, &energy = flow->energy] {
    fields->Share("from", &energy.from);
    fields->Int("answers", 2, 64, &energy.answers);
    fields->Number("velocity_weight", 0, kMaxWeight, &energy.velocity_weight);
    fields->Number("block_weight", 0, kMaxWeight, &energy.block_weight);
    fields->Int("block_frames", 2, 1000, &energy.block_frames);
    fields->Number("feet_weight", 0, kMaxWeight, &energy.feet_weight);
    fields->Number("hands_weight", 0, kMaxWeight, &energy.hands_weight);
    fields->Number("near_hands", 1e-3, 10, &energy.near_hands);
  });
  if (fields->Has("leaders")) {
    fields->Section("leaders", [&] { fields->Number("share", 0, 0, &flow->leaders.share); });
  }
  if (fields->Has("stillness")) {
    fields->Section("stillness", [&, &stillness = flow->stillness] {
      fields->Share("pauses", &stillness.pauses);
      fields->Share("ends", &stillness.ends);
      fields->Share("motionless", &stillness.motionless);
      fields->Share("unlabelled", &stillness.unlabelled);
      fields->Share("clean", &stillness.clean);
    });
  }
  if (fields->Has("critic")) {
    fields->Section("critic", [&, &critic = flow->critic] {
      fields->Int("steps", 0, kMaxEpochs, &critic.steps);
      fields->Int("answers", 1, 64, &critic.answers);
    });
  }
}

void Declare(Fields* fields, PaperTraining* paper) {
  fields->Section("dropout", [&] {
    fields->Number("slices", 0, 0.95, &paper->dropout.slices);
    fields->Number("encoded", 0, 0.95, &paper->dropout.encoded);
  });
  fields->Section("losses", [&, &l = paper->losses] {
    fields->Number("bone", 0, kMaxWeight, &l.bone);
    fields->Number("continuity", 0, kMaxWeight, &l.continuity);
    fields->Word("continuity_form", {"hinge", "path_length"}, &l.continuity_form);
    fields->Number("adversarial", 0, kMaxWeight, &l.adversarial);
  });
  fields->Section("discriminator", [&, &d = paper->discriminator] {
    fields->Bool("binary", &d.binary);
    fields->Int("hidden", 1, kMaxUnits, &d.hidden);
    fields->Number("learning_rate", 1e-9, 10, &d.learning_rate);
    fields->Number("dropout", 0, 0.95, &d.dropout);
    fields->Bool("unit_norm_kernels", &d.unit_norm_kernels);
  });
  fields->Share("graded_labels", &paper->graded_labels);
}

constexpr int kMaxDepth = 4;

// Declares every setting that does not depend on the method.
void Declare(Fields* fields, TrainingOptions* options) {
  fields->Choice("standardisation", checkpoint::kStandardisationNames, &options->standardisation);
  fields->Section("optimiser", [&, &optimiser = options->optimiser] {
    fields->Word("name", {"adam", "rmsprop"}, &optimiser.name);
    fields->Number("learning_rate", 1e-9, 10, &optimiser.learning_rate);
    fields->Word("schedule", {"one_cycle", "constant", "cosine"}, &optimiser.schedule);
    if (optimiser.schedule == "cosine") {
      fields->Int("warm_up_steps", 0, kMaxEpochs, &optimiser.warm_up_steps);
      fields->Share("last_share", &optimiser.last_share);
      fields->Number("second_moment", 0, 0.999999, &optimiser.second_moment);
    }
    fields->Number("weight_decay", 0, 10, &optimiser.weight_decay);
    fields->Number("gradient_clip", 0, 1e9, &optimiser.gradient_clip);
    fields->Number("average_decay", 0, 0.999999, &optimiser.average_decay);
  });
  fields->Int("epochs", 1, kMaxEpochs, &options->epochs);
  fields->Int("batch", 1, 65536, &options->batch);
  int64_t seed = static_cast<int64_t>(options->seed);
  fields->Int("seed", 0, INT64_MAX, &seed);
  options->seed = static_cast<uint64_t>(seed);
  fields->Section("augmentation", [&, &augmentation = options->augmentation] {
    fields->Share("mirror", &augmentation.mirror);
    fields->Share("swap_roles", &augmentation.swap_roles);
    fields->Number("body_scale", 0, 0.9, &augmentation.body_scale);
    fields->Number("time_warp", 0, 2, &augmentation.time_warp);
    fields->Number("yaw", 0, 4, &augmentation.yaw);
    fields->Number("leader_yaw", 0, 4, &augmentation.leader_yaw);
    fields->Number("noise", 0, 10, &augmentation.noise);
    fields->Number("body_noise", 0, 10, &augmentation.body_noise);
    fields->Share("crop", &augmentation.crop);
  });
  fields->Section("start", [&, &start = options->start] {
    fields->Share("root", &start.root);
    fields->Share("pose", &start.pose);
  });
  fields->Section("validation", [&, &validation = options->validation] {
    fields->Words("subjects", &validation.subjects);
    fields->Number("fraction", 0, 0.9, &validation.fraction);
  });
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

Method ReadMethod(base::ObjectReader* root, Fields* fields) {
  checkpoint::Architecture architecture;
  checkpoint::ReadSection(root, "generator", [&architecture](base::ObjectReader* generator) {
    architecture =
        checkpoint::ReadArchitecture(generator->Has(checkpoint::kArchitectureKind), generator);
  });
  Method method =
      std::visit([](const auto& one) -> Method { return MethodFor(one); }, architecture);
  if (root->ok()) std::visit([fields](auto& one) { Declare(fields, &one); }, method);
  return method;
}

absl::StatusOr<TrainingOptions> ReadOptions(const json& value) {
  base::ObjectReader root(value, "");
  Fields fields(&root);
  TrainingOptions options;
  options.method = ReadMethod(&root, &fields);
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

// Adds the values in an object by dotted path, as the shortest texts that read back the same.
void AddTexts(const nlohmann::ordered_json& object, const std::string& path,
              std::map<std::string, std::string>* texts) {
  for (const auto& [name, value] : object.items()) {
    if (value.is_object()) {
      AddTexts(value, path + name + ".", texts);
      continue;
    }
    (*texts)[path + name] = value.is_string() ? value.get<std::string>()
                            : value.is_array()
                                ? absl::StrJoin(value.get<std::vector<std::string>>(), " ")
                                : std::string(absl::StripSuffix(value.dump(), ".0"));
  }
}

// Parses a base and the changes to it.
absl::StatusOr<TrainingOptions> ParseDerived(const json& value, const Replacements& replacements) {
  base::ObjectReader reader(value, "");
  const std::string name = reader.String("base", kMaxNameBytes);
  const NamedConfig* const base = FindConfig(name);
  if (reader.ok() && base == nullptr) {
    reader.Fail("base", absl::StrCat("expected a named configuration, got ", base::Quoted(name)));
  }
  const json& set = reader.Object("set");
  DUET_RETURN_IF_ERROR(reader.Finish());
  Replacements all;
  for (const auto& [path, setting] : set.items()) all.emplace_back(path, setting.dump());
  all.insert(all.end(), replacements.begin(), replacements.end());
  return ParseConfig(base->json, all);
}

// A mirror image is wrong if left and right joints are not exchanged.
absl::Status CheckMirror(const TrainingOptions::Augmentation& augmentation,
                         const motion::Skeleton& skeleton) {
  if (augmentation.mirror == 0) return absl::OkStatus();
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

const NamedConfig* FindConfig(std::string_view name) {
  for (const NamedConfig& config : NamedConfigs()) {
    if (config.name == name) return &config;
  }
  return nullptr;
}

absl::StatusOr<TrainingOptions> ParseConfig(std::string_view text,
                                            const Replacements& replacements) {
  DUET_TRY(json root, base::ParseStrictJson(text, kMaxDepth));
  if (root.contains("base")) return ParseDerived(root, replacements);
  for (const auto& [path, value] : replacements) {
    DUET_RETURN_IF_ERROR(Replace(path, value, &root));
  }
  return ReadOptions(root);
}

checkpoint::Architecture ArchitectureOf(const TrainingOptions& options) {
  return std::visit([](const auto& one) -> checkpoint::Architecture { return one.architecture; },
                    options.method);
}

std::map<std::string, std::string> Describe(const TrainingOptions& options) {
  TrainingOptions declared = options;
  nlohmann::ordered_json written;
  Fields fields(&written);
  Declare(&fields, &declared);
  std::visit([&fields](auto& one) { Declare(&fields, &one); }, declared.method);
  std::map<std::string, std::string> description;
  AddTexts(written, "", &description);
  return description;
}

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
