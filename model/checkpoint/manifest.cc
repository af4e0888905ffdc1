#include "model/checkpoint/manifest.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "model/base/strict_json.h"
#include "model/checkpoint/architecture_json.h"
#include "model/checkpoint/leader_json.h"
#include "model/engine/windows.h"
#include "model/motion/motion_limits.h"
#include "model/motion/skeleton_json.h"

namespace duet::checkpoint {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Far above any use, and low enough that a small file cannot ask for a huge network.
constexpr int kMaxClasses = 256;
constexpr int kMaxWindowFrames = 4096;
constexpr int kMaxMapEntries = 1024;
constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kMaxTextBytes = 4096;
constexpr int kMaxDepth = 6;
constexpr std::size_t kSha256HexBytes = 64;
constexpr char kTouchingClasses[] = "touching_classes";
constexpr char kHandContacts[] = "hand_contacts";
constexpr char kTrunkContacts[] = "trunk_contacts";
constexpr char kFacingClasses[] = "facing_classes";
constexpr char kBoneRatios[] = "bone_ratios";
constexpr char kDefaultSeeds[] = "default_seeds";
constexpr char kTerms[] = "terms";
constexpr char kLookaheadFrames[] = "lookahead_frames";
constexpr char kFreeForAllUses[] = "free_for_all_uses";
// Fields of former stages of the engine. Checkpoints that have them are read; nothing uses them.
constexpr const char* kFormerFields[] = {"turning_classes", "steps_in_time",    "hip_height",
                                         "astride_seconds", "held_out_seconds", "strikes"};

// Characters that are safe in names of files, folders, tensors and metrics.
bool IsPlain(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
}

bool IsPlainName(const std::string& name) {
  if (name.empty() || name.size() > kMaxNameBytes || name.front() == '.') return false;
  return std::all_of(name.begin(), name.end(), IsPlain);
}

constexpr char kPlainName[] = "1 to 64 letters, digits, '_', '-' or '.', not beginning with '.'";

std::string ReadName(base::ObjectReader* reader, const std::string& key) {
  std::string name = reader->String(key, kMaxTextBytes);
  if (reader->ok() && !IsPlainName(name)) {
    reader->Fail(key, absl::StrCat("expected ", kPlainName, ", got ", json(name).dump()));
  }
  return name;
}

void ReadGenerator(const json& value, base::ObjectReader* root, Manifest* manifest) {
  base::ObjectReader reader(value, "generator");
  const bool has_kind = manifest->format_version > 1;
  SetArchitecture(ReadArchitecture(has_kind, &reader), manifest);
  root->Update(reader.Finish());
}

absl::StatusOr<WeightsFile> ReadWeightsFile(const json& value) {
  base::ObjectReader reader(value, "weights");
  WeightsFile weights;
  weights.file = ReadName(&reader, "file");
  weights.bytes = static_cast<uint64_t>(reader.Int("bytes", 1, kMaxWeightsBytes));
  weights.sha256 = reader.String("sha256", kSha256HexBytes);
  const bool is_hex = weights.sha256.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (reader.ok() && (!is_hex || weights.sha256.size() != kSha256HexBytes)) {
    reader.Fail("sha256",
                absl::StrCat("expected ", kSha256HexBytes, " digits of lower-case hex, got ",
                             json(weights.sha256).dump()));
  }
  if (absl::Status status = reader.Finish(); !status.ok()) return status;
  return weights;
}

void ReadTraining(base::ObjectReader* reader, Manifest* manifest) {
  const json& object = reader->Object("training");
  if (object.size() > kMaxMapEntries) reader->Fail("training", "too many entries");
  base::ObjectReader fields(object, "training");
  for (const auto& field : object.items()) {
    manifest->training[field.key()] = fields.String(field.key(), kMaxTextBytes);
  }
  reader->Update(fields.Finish());
}

void ReadMetrics(base::ObjectReader* reader, Manifest* manifest) {
  constexpr double kAny = std::numeric_limits<double>::max();
  const json& object = reader->Object("metrics");
  if (object.size() > kMaxMapEntries) reader->Fail("metrics", "too many entries");
  base::ObjectReader fields(object, "metrics");
  for (const auto& field : object.items()) {
    manifest->metrics[field.key()] = fields.Number(field.key(), -kAny, kAny);
  }
  reader->Update(fields.Finish());
}

std::string ReadTime(base::ObjectReader* reader, const std::string& key) {
  std::string text = reader->String(key, kMaxNameBytes);
  absl::Time time;
  std::string problem;
  if (reader->ok() && !absl::ParseTime(absl::RFC3339_full, text, &time, &problem)) {
    reader->Fail(key, absl::StrCat("expected a time as in RFC 3339, got ", json(text).dump()));
  }
  return text;
}

// Moves a section's value to `out`, or records its error.
template <typename T>
void Take(absl::StatusOr<T> section, base::ObjectReader* reader, T* out) {
  reader->Update(section.status());
  if (section.ok()) *out = *std::move(section);
}

// Older checkpoints have no such field; the only class of their data in which bodies touch is
// "hug".
void ReadTouchingClasses(base::ObjectReader* reader, engine::ModelDescription* model) {
  const std::vector<std::string>& classes = model->classes;
  const auto is_class = [&](const std::string& name) {
    return std::find(classes.begin(), classes.end(), name) != classes.end();
  };
  if (!reader->Has(kTouchingClasses)) {
    if (is_class("hug")) model->touching_classes = {"hug"};
    return;
  }
  model->touching_classes = reader->UniqueStrings(kTouchingClasses, kMaxClasses, kMaxNameBytes);
  for (const std::string& name : model->touching_classes) {
    if (is_class(name)) continue;
    reader->Fail(kTouchingClasses,
                 absl::StrCat("expected one of classes, got ", json(name).dump()));
  }
}

// Calls `add(class, number)` for every class of an optional object of numbers in [0, most].
template <typename Add>
void ReadClassNumbers(base::ObjectReader* reader, const char* name,
                      const std::vector<std::string>& classes, double most, const Add& add) {
  if (!reader->Has(name)) return;
  const json& object = reader->Object(name);
  base::ObjectReader fields(object, name);
  for (const auto& field : object.items()) {
    if (std::find(classes.begin(), classes.end(), field.key()) == classes.end()) {
      reader->Fail(name, absl::StrCat("expected one of classes, got ", json(field.key()).dump()));
    }
    add(field.key(), fields.Number(field.key(), 0, most));
  }
  reader->Update(fields.Finish());
}

// What people do in some of the classes. Older checkpoints have no such fields.
void ReadHabits(base::ObjectReader* reader, engine::ModelDescription* model) {
  constexpr double kFarthestHands = 1, kTurnedRound = 180;
  ReadClassNumbers(reader, kHandContacts, model->classes, kFarthestHands,
                   [model](const std::string& name, double metres) {
                     model->hand_contacts.push_back({name, metres});
                   });
  ReadClassNumbers(reader, kFacingClasses, model->classes, kTurnedRound,
                   [model](const std::string& name, double degrees) {
                     model->facing_classes.push_back({name, degrees});
                   });
  for (const char* field : kFormerFields) reader->Ignore(field);
}

void ReadDefaultSeeds(base::ObjectReader* reader, engine::ModelDescription* model) {
  if (!reader->Has(kDefaultSeeds)) return;
  for (const json& value : reader->Array(kDefaultSeeds, engine::kMostDefaultSeeds)) {
    if (!value.is_number_unsigned()) {
      reader->Fail(absl::StrCat(kDefaultSeeds, "[", model->default_seeds.size(), "]"),
                   absl::StrCat("expected a whole number from 0, got ", value.dump()));
      return;
    }
    model->default_seeds.push_back(value.get<uint64_t>());
  }
}

void ReadTrunkContacts(base::ObjectReader* reader, engine::ModelDescription* model) {
  constexpr double kFarthest = 2;  // lengths of the trunk
  if (!reader->Has(kTrunkContacts)) return;
  const std::vector<std::string>& classes = model->classes;
  for (const json& value : reader->Array(kTrunkContacts, kMaxMapEntries)) {
    const std::string path = absl::StrCat(kTrunkContacts, "[", model->trunk_contacts.size(), "]");
    if (!value.is_object()) {
      return reader->Fail(path, absl::StrCat("expected an object, got ", base::Shown(value)));
    }
    base::ObjectReader fields(value, path);
    engine::TrunkContact contact;
    contact.interaction_class = fields.String("class", kMaxNameBytes);
    if (std::find(classes.begin(), classes.end(), contact.interaction_class) == classes.end()) {
      fields.Fail("class", absl::StrCat("expected one of classes, got ",
                                        json(contact.interaction_class).dump()));
    }
    contact.hand = fields.String("hand", kMaxTextBytes);
    if (model->skeleton.Find(contact.hand) < 0) {
      fields.Fail("hand", absl::StrCat("expected one of skeleton.joint_names, got ",
                                       json(contact.hand).dump()));
    }
    const auto along = [&](const char* axis) {
      return static_cast<float>(fields.Number(axis, -kFarthest, kFarthest));
    };
    contact.place = {along("across"), along("up"), along("forward")};
    reader->Update(fields.Finish());
    model->trunk_contacts.push_back(std::move(contact));
  }
}

// One for each bone of the skeleton. Older checkpoints have none.
void ReadBoneRatios(base::ObjectReader* reader, engine::ModelDescription* model) {
  constexpr double kSmallest = 0.1, kLargest = 10;
  if (!reader->Has(kBoneRatios)) return;
  const std::size_t bones = model->skeleton.bones.size();
  for (const json& value : reader->Array(kBoneRatios, bones)) {
    const double ratio = value.is_number() ? value.get<double>() : 0;
    if (ratio < kSmallest || ratio > kLargest) {
      reader->Fail(absl::StrCat(kBoneRatios, "[", model->bone_ratios.size(), "]"),
                   absl::StrCat("expected a number from ", kSmallest, " to ", kLargest, ", got ",
                                base::Shown(value)));
    }
    model->bone_ratios.push_back(ratio);
  }
  if (reader->ok() && model->bone_ratios.size() != bones) {
    reader->Fail(kBoneRatios, absl::StrCat("expected ", bones, " numbers (one for each bone), got ",
                                           model->bone_ratios.size()));
  }
}

// Windows with a lookahead share their settled frames and the lookahead, and must still advance.
void ReadLookahead(base::ObjectReader* reader, engine::ModelDescription* model) {
  if (!reader->Has(kLookaheadFrames)) return;
  const int most = model->window_frames - engine::SettledOverlap(model->window_frames) - 1;
  model->lookahead_frames = static_cast<int>(reader->Int(kLookaheadFrames, 0, std::max(0, most)));
}

void ReadModel(base::ObjectReader* reader, engine::ModelDescription* model) {
  model->name = ReadName(reader, "name");
  model->version = static_cast<int>(reader->Int("version", 1, std::numeric_limits<int>::max()));
  model->description = reader->String("description", kMaxTextBytes);
  if (reader->Has(kTerms)) model->terms = reader->String(kTerms, kMaxTextBytes);
  if (reader->Has(kFreeForAllUses)) model->free_for_all_uses = reader->Bool(kFreeForAllUses);
  model->frame_rate_hz = reader->Number("frame_rate_hz", 1, motion::kMaxServedFrameRateHz);
  model->window_frames = static_cast<int>(reader->Int("window_frames", 2, kMaxWindowFrames));
  ReadLookahead(reader, model);
  model->classes = reader->UniqueStrings("classes", kMaxClasses, kMaxNameBytes);
  if (reader->ok() && model->classes.empty()) {
    reader->Fail("classes", "expected at least one class, got none");
  }
  ReadTouchingClasses(reader, model);
  ReadHabits(reader, model);
}

// Older checkpoints have none, and version 1 does not allow them.
void ReadLeaders(base::ObjectReader* reader, Manifest* manifest) {
  if (manifest->format_version == 1 || !reader->Has(kLeaderStatistics)) return;
  const json& leaders = reader->Object(kLeaderStatistics);
  if (!reader->ok()) return;
  Take(ReadLeaderStatistics(leaders, manifest->model.skeleton, kLeaderStatistics), reader,
       &manifest->model.leader_statistics.emplace());
}

absl::StatusOr<Manifest> ReadManifest(const json& root) {
  base::ObjectReader reader(root, "");
  Manifest manifest;
  // First, because only the first problem is reported and a newer format may differ in any field.
  manifest.format_version =
      static_cast<int>(reader.Int("format_version", 1, kCheckpointFormatVersion));
  ReadModel(&reader, &manifest.model);
  motion::SkeletonDocument skeleton;
  const json& skeleton_object = reader.Object("skeleton");
  if (reader.ok()) Take(motion::ReadSkeleton(skeleton_object, "skeleton"), &reader, &skeleton);
  manifest.model.skeleton = std::move(skeleton.skeleton);
  ReadBoneRatios(&reader, &manifest.model);
  if (reader.ok()) ReadTrunkContacts(&reader, &manifest.model);
  ReadDefaultSeeds(&reader, &manifest.model);
  ReadLeaders(&reader, &manifest);
  manifest.model.partner_direction = ReadDirectionRegression(
      manifest.model.skeleton, static_cast<int>(manifest.model.classes.size()), &reader);
  const json& generator = reader.Object("generator");
  if (reader.ok()) ReadGenerator(generator, &reader, &manifest);
  manifest.parts = std::move(skeleton.parts);
  manifest.standardisation = ReadNamed(&reader, "standardisation", kStandardisationNames);
  const json& weights = reader.Object("weights");
  if (reader.ok()) Take(ReadWeightsFile(weights), &reader, &manifest.weights);
  manifest.model.weights_sha256 = manifest.weights.sha256;
  manifest.git_revision = reader.String("git_revision", kMaxTextBytes);
  manifest.created = ReadTime(&reader, "created");
  ReadTraining(&reader, &manifest);
  ReadMetrics(&reader, &manifest);
  if (absl::Status status = reader.Finish(); !status.ok()) return status;
  return manifest;
}

// Limits the whole network: each size can be in range while their product is not.
absl::Status CheckTotalSize(const Manifest& manifest) {
  double bytes = 0;
  for (const TensorSpec& spec : ExpectedTensors(manifest)) {
    double values = 1;
    for (int64_t size : spec.shape) values *= static_cast<double>(size);
    bytes += values * sizeof(float);
  }
  if (bytes <= static_cast<double>(kMaxWeightsBytes)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      "generator: expected sizes of at most ", kMaxWeightsBytes, " bytes of weights, got ", bytes));
}

ordered_json GeneratorToJson(const Manifest& manifest) {
  ordered_json object = ToJson(manifest.architecture);
  if (manifest.format_version == 1) object.erase(kArchitectureKind);
  return object;
}

}  // namespace

std::string ToPlainName(std::string_view text) {
  std::string name(text.substr(0, kMaxNameBytes));
  for (char& c : name) {
    if (!IsPlain(c)) c = '_';
  }
  if (name.empty() || name.front() == '.') name.insert(name.begin(), '_');
  return name.substr(0, kMaxNameBytes);
}

absl::StatusOr<Manifest> ParseManifest(std::string_view text) {
  if (text.size() > kMaxManifestBytes) {
    return absl::InvalidArgumentError(absl::StrCat("manifest: expected at most ", kMaxManifestBytes,
                                                   " bytes, got ", text.size()));
  }
  const absl::StatusOr<json> root = base::ParseStrictJson(text, kMaxDepth);
  absl::StatusOr<Manifest> manifest = root.ok() ? ReadManifest(*root) : root.status();
  absl::Status status = manifest.ok() ? CheckTotalSize(*manifest) : manifest.status();
  if (!status.ok())
    return absl::Status(status.code(), absl::StrCat("manifest: ", status.message()));
  return manifest;
}

std::string SerializeManifest(const Manifest& manifest) {
  const engine::ModelDescription& model = manifest.model;
  ordered_json root = {
      {"format_version", manifest.format_version},
      {"name", model.name},
      {"version", model.version},
      {"description", model.description},
      {"created", manifest.created},
      {"git_revision", manifest.git_revision},
      {"frame_rate_hz", model.frame_rate_hz},
      {"window_frames", model.window_frames},
      {"classes", model.classes},
      {"standardisation", std::string(NameOf(kStandardisationNames, manifest.standardisation))},
      {"skeleton", motion::SkeletonToJson(model.skeleton, manifest.parts)},
      {"generator", GeneratorToJson(manifest)},
      {"weights",
       {{"file", manifest.weights.file},
        {"bytes", manifest.weights.bytes},
        {"sha256", manifest.weights.sha256}}},
      {"training", manifest.training},
      {"metrics", manifest.metrics}};
  if (manifest.format_version > 1) root[kTouchingClasses] = model.touching_classes;
  for (const engine::HandContact& contact : model.hand_contacts) {
    root[kHandContacts][contact.interaction_class] = contact.metres;
  }
  for (const engine::TrunkContact& contact : model.trunk_contacts) {
    root[kTrunkContacts].push_back({{"class", contact.interaction_class},
                                    {"hand", contact.hand},
                                    {"across", contact.place.x},
                                    {"up", contact.place.y},
                                    {"forward", contact.place.z}});
  }
  for (const engine::FacingClass& facing : model.facing_classes) {
    root[kFacingClasses][facing.interaction_class] = facing.degrees;
  }
  if (!model.bone_ratios.empty()) root[kBoneRatios] = model.bone_ratios;
  if (!model.default_seeds.empty()) root[kDefaultSeeds] = model.default_seeds;
  if (!model.terms.empty()) root[kTerms] = model.terms;
  if (model.lookahead_frames > 0) root[kLookaheadFrames] = model.lookahead_frames;
  if (model.free_for_all_uses) root[kFreeForAllUses] = true;
  if (model.leader_statistics) {
    root[kLeaderStatistics] = LeaderStatisticsToJson(*model.leader_statistics);
  }
  if (model.partner_direction) {
    root[kPartnerDirection] = DirectionRegressionToJson(*model.partner_direction);
  }
  return root.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace duet::checkpoint
