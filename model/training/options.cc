#include "model/training/options.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/checkpoint/flow_json.h"
#include "model/checkpoint/names.h"
#include "model/retargeting/anatomy.h"

namespace duet::training {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 4;
constexpr size_t kMaxWord = 64;
constexpr int64_t kMaxUnits = 4096;
constexpr int64_t kMaxEpochs = 1000000;

std::string OneOf(base::ObjectReader* reader, const std::string& key,
                  const std::vector<std::string>& choices) {
  std::string value = reader->String(key, kMaxWord);
  if (reader->ok() && std::find(choices.begin(), choices.end(), value) == choices.end()) {
    reader->Fail(
        key, absl::StrCat(base::Quoted(value), ", wanted one of ", absl::StrJoin(choices, ", ")));
  }
  return value;
}

// A choice of a table (checkpoint/names.h).
template <typename T, size_t n>
T OneOf(base::ObjectReader* reader, const std::string& key,
        const checkpoint::Named<T> (&table)[n]) {
  std::vector<std::string> choices;
  for (const checkpoint::Named<T>& row : table) choices.emplace_back(row.name);
  return ValueOf(table, OneOf(reader, key, choices)).value_or(table[0].value);
}

double Probability(base::ObjectReader* reader, const std::string& key) {
  return reader->Number(key, 0, 1);
}

void Read(base::ObjectReader* reader, checkpoint::GeneratorArchitecture* out) {
  out->variant = OneOf(reader, "variant", checkpoint::kVariantNames);
  out->follower_start = reader->Bool("follower_start");
  out->slice_features = static_cast<int>(reader->Int("slice_features", 0, kMaxUnits));
  out->encoder_hidden = static_cast<int>(reader->Int("encoder_hidden", 1, kMaxUnits));
  out->attention = static_cast<int>(reader->Int("attention", 1, kMaxUnits));
  out->base_pose = reader->Bool("base_pose");
}

void Read(base::ObjectReader* reader, checkpoint::FlowArchitecture* out) {
  OneOf(reader, checkpoint::kGeneratorKind, {checkpoint::kFlowKind});
  *out = checkpoint::ReadFlowArchitecture(reader);
}

void Read(base::ObjectReader* reader, TrainingOptions::Dropout* out) {
  out->slices = reader->Number("slices", 0, 0.95);
  out->encoded = reader->Number("encoded", 0, 0.95);
}

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

void Read(base::ObjectReader* reader, TrainingOptions::Losses* out) {
  out->reconstruction = OneOf(reader, "reconstruction", {"l1", "l2", "norm"});
  out->reconstruction_weight = reader->Number("reconstruction_weight", 0, 1e6);
  out->bone = reader->Number("bone", 0, 1e6);
  out->continuity = reader->Number("continuity", 0, 1e6);
  out->continuity_form = OneOf(reader, "continuity_form", {"hinge", "path_length"});
  out->continuity_gap = reader->Int("continuity_gap", 2, 64);
  out->continuity_margin = reader->Number("continuity_margin", 0, 1e3);
  out->adversarial = reader->Number("adversarial", 0, 1e6);
}

void Read(base::ObjectReader* reader, TrainingOptions::DiscriminatorSettings* out) {
  out->binary = reader->Bool("binary");
  out->hidden = reader->Int("hidden", 1, kMaxUnits);
  out->learning_rate = reader->Number("learning_rate", 1e-9, 10);
  out->dropout = reader->Number("dropout", 0, 0.95);
  out->unit_norm_kernels = reader->Bool("unit_norm_kernels");
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

void Read(base::ObjectReader* reader, TrainingOptions::Flow* out) {
  out->dropout = reader->Number("dropout", 0, 0.95);
  out->passes = reader->Int("passes", 1, kMaxEpochs);
  out->target_smoothing = reader->Number("target_smoothing", 0, 100);
  out->pair_scale = reader->Number("pair_scale", 0, 0.9);
  out->unlabelled = Probability(reader, "unlabelled");
  out->several_known = Probability(reader, "several_known");
  out->known_noise = reader->Number("known_noise", 0, 10);
  out->difference_weight = reader->Number("difference_weight", 0, 1e6);
  out->bone_weight = reader->Number("bone_weight", 0, 1e6);
  out->slide_weight = reader->Number("slide_weight", 0, 1e6);
  out->slide_speed = reader->Number("slide_speed", 0, 100);
  out->least_remaining = reader->Number("least_remaining", 1e-6, 1);
}

void Read(base::ObjectReader* reader, TrainingOptions::Flow::Drift* out) {
  out->share = Probability(reader, "share");
  out->tilt = reader->Number("tilt", 0, 4);
  out->bend = reader->Number("bend", 0, 4);
  out->turn = reader->Number("turn", 0, 4);
  out->root = reader->Number("root", 0, 10);
  out->height = reader->Number("height", 0, 10);
  out->joints = reader->Number("joints", 0, 10);
  out->frames = reader->Int("frames", 1, 1000);
}

void Read(base::ObjectReader* reader, TrainingOptions::Flow::Energy* out) {
  out->from = Probability(reader, "from");
  out->answers = reader->Int("answers", 2, 64);
  out->dropout = reader->Number("dropout", 0, 0.95);
  out->velocity_weight = reader->Number("velocity_weight", 0, 1e6);
  out->block_weight = reader->Number("block_weight", 0, 1e6);
  out->block_frames = reader->Int("block_frames", 2, 1000);
}

void Read(base::ObjectReader* reader, TrainingOptions::Start* out) {
  out->root = Probability(reader, "root");
  out->pose = Probability(reader, "pose");
  if (reader->ok() && out->root + out->pose > 1) {
    reader->Fail("pose", absl::StrCat(out->pose, ", wanted at most ", 1 - out->root,
                                      ": root and pose are shares of all clips"));
  }
}

void Read(base::ObjectReader* reader, TrainingOptions::Validation* out) {
  out->subjects = reader->Strings("subjects", 256);
  out->fraction = reader->Number("fraction", 0, 0.9);
  out->patience = reader->Int("patience", 0, kMaxEpochs);
}

template <typename Section>
absl::Status ReadSection(base::ObjectReader* root, const std::string& name, Section* out) {
  const json& object = root->Object(name);
  if (!root->ok()) return absl::OkStatus();  // the root remembers what was wrong
  base::ObjectReader reader(object, name);
  Read(&reader, out);
  return reader.Finish();
}

// A generator that says its kind is the sampling one; the paper's has no field for it.
bool IsFlow(const json& root) {
  const auto generator = root.find("generator");
  return generator != root.end() && generator->is_object() &&
         generator->contains(checkpoint::kGeneratorKind);
}

absl::StatusOr<TrainingOptions> ReadOptions(const json& value) {
  base::ObjectReader root(value, "");
  TrainingOptions options;
  absl::Status status;
  const auto section = [&](const std::string& name, auto* out) {
    if (status.ok()) status = ReadSection(&root, name, out);
  };
  const bool is_flow = IsFlow(value);
  if (is_flow) {
    section("generator", &options.flow.emplace().generator);
    section("flow", &*options.flow);
    section("drift", &options.flow->drift);
    section("energy", &options.flow->energy);
  } else {
    section("generator", &options.generator);
    section("dropout", &options.dropout);
    section("losses", &options.losses);
    section("discriminator", &options.discriminator);
    options.graded_labels = root.Number("graded_labels", 0, 1);
  }
  options.standardisation = OneOf(&root, "standardisation", checkpoint::kStandardisationNames);
  section("optimiser", &options.optimiser);
  options.epochs = root.Int("epochs", 1, kMaxEpochs);
  options.batch = root.Int("batch", 1, 65536);
  options.seed = static_cast<uint64_t>(root.Int("seed", 0, INT64_MAX));
  section("augmentation", &options.augmentation);
  section("start", &options.start);
  section("validation", &options.validation);
  if (!status.ok()) return status;
  if (status = root.Finish(); !status.ok()) return status;
  return options;
}

// A replacement's value: JSON where it parses as such, else the text itself.
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

// The shortest text that reads back as the same number: a state belongs to one setting exactly.
std::string Text(double value) {
  const std::string text = json(value).dump();
  return std::string(absl::StripSuffix(text, ".0"));
}
std::string Text(bool value) { return value ? "true" : "false"; }

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

namespace {

using Description = std::map<std::string, std::string>;

void DescribePaper(const TrainingOptions& o, Description* out) {
  out->insert({{"dropout.slices", Text(o.dropout.slices)},
               {"dropout.encoded", Text(o.dropout.encoded)},
               {"losses.reconstruction", o.losses.reconstruction},
               {"losses.reconstruction_weight", Text(o.losses.reconstruction_weight)},
               {"losses.bone", Text(o.losses.bone)},
               {"losses.continuity", Text(o.losses.continuity)},
               {"losses.continuity_form", o.losses.continuity_form},
               {"losses.continuity_gap", absl::StrCat(o.losses.continuity_gap)},
               {"losses.continuity_margin", Text(o.losses.continuity_margin)},
               {"losses.adversarial", Text(o.losses.adversarial)},
               {"discriminator.binary", Text(o.discriminator.binary)},
               {"discriminator.hidden", absl::StrCat(o.discriminator.hidden)},
               {"discriminator.learning_rate", Text(o.discriminator.learning_rate)},
               {"discriminator.dropout", Text(o.discriminator.dropout)},
               {"discriminator.unit_norm_kernels", Text(o.discriminator.unit_norm_kernels)},
               {"graded_labels", Text(o.graded_labels)}});
}

void DescribeCosine(const TrainingOptions::Optimiser& o, Description* out) {
  out->insert({{"optimiser.warm_up_steps", absl::StrCat(o.warm_up_steps)},
               {"optimiser.last_share", Text(o.last_share)},
               {"optimiser.second_moment", Text(o.second_moment)}});
}

void DescribeFlow(const TrainingOptions::Flow& f, Description* out) {
  out->insert({{"flow.dropout", Text(f.dropout)},
               {"flow.passes", absl::StrCat(f.passes)},
               {"flow.target_smoothing", Text(f.target_smoothing)},
               {"flow.pair_scale", Text(f.pair_scale)},
               {"flow.unlabelled", Text(f.unlabelled)},
               {"flow.several_known", Text(f.several_known)},
               {"flow.known_noise", Text(f.known_noise)},
               {"flow.difference_weight", Text(f.difference_weight)},
               {"flow.bone_weight", Text(f.bone_weight)},
               {"flow.slide_weight", Text(f.slide_weight)},
               {"flow.slide_speed", Text(f.slide_speed)},
               {"flow.least_remaining", Text(f.least_remaining)},
               {"drift.share", Text(f.drift.share)},
               {"drift.tilt", Text(f.drift.tilt)},
               {"drift.bend", Text(f.drift.bend)},
               {"drift.turn", Text(f.drift.turn)},
               {"drift.root", Text(f.drift.root)},
               {"drift.height", Text(f.drift.height)},
               {"drift.joints", Text(f.drift.joints)},
               {"drift.frames", absl::StrCat(f.drift.frames)},
               {"energy.from", Text(f.energy.from)},
               {"energy.answers", absl::StrCat(f.energy.answers)},
               {"energy.dropout", Text(f.energy.dropout)},
               {"energy.velocity_weight", Text(f.energy.velocity_weight)},
               {"energy.block_weight", Text(f.energy.block_weight)},
               {"energy.block_frames", absl::StrCat(f.energy.block_frames)}});
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
  if (o.flow) {
    DescribeFlow(*o.flow, &description);
  } else {
    DescribePaper(o, &description);
  }
  return description;
}

namespace {

// Nobody's mirror image is right whose arms stay where they are.
absl::Status CheckMirror(const TrainingOptions::Augmentation& augmentation,
                         const motion::Skeleton& skeleton) {
  if (augmentation.mirror == 0 && augmentation.mirror_handed == 0) return absl::OkStatus();
  const std::vector<int> counterparts = retargeting::CounterpartJoints(skeleton.joint_names);
  for (size_t joint = 0; joint < counterparts.size(); ++joint) {
    if (counterparts[joint] != static_cast<int>(joint)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "augmentation.mirror: ", augmentation.mirror,
      ", but no joint's name says left or right; wanted names such as left_hand and right_hand, or "
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
        absl::StrCat("validation.subjects: ", base::Quoted(name), ", wanted subjects of the data: ",
                     subjects.empty() ? "it names none" : absl::StrJoin(subjects, ", ")));
  }
  return absl::OkStatus();
}

}  // namespace duet::training
