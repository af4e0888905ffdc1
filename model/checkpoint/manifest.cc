#include "model/checkpoint/manifest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "model/base/strict_json.h"
#include "model/checkpoint/architecture_json.h"
#include "model/engine/windows.h"
#include "model/motion/motion_limits.h"
#include "model/motion/skeleton_json.h"

namespace duet::checkpoint {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Feature = engine::LeaderStatistics::Feature;

// Far above any use, and low enough that a small file cannot ask for a huge network.
constexpr int kMaxClasses = 256;
constexpr int kMaxWindowFrames = 4096;
constexpr int kMaxMapEntries = 1024;
constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kMaxTextBytes = 4096;
constexpr int kMaxDepth = 6;
constexpr std::size_t kSha256HexBytes = 64;
// Of measurements of people: far above any person, and low enough that squares and sums cannot
// overflow.
constexpr double kMost = 1e6, kLeast = 1e-6;
constexpr double kSmallestRatio = 0.1, kLargestRatio = 10;  // of followers' bones to leaders'
constexpr char kLeaderStatistics[] = "leader_statistics";
constexpr char kPartnerDirection[] = "partner_direction";
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

WeightsFile ReadWeightsFile(base::ObjectReader* reader) {
  WeightsFile weights;
  weights.file = ReadName(reader, "file");
  weights.bytes = static_cast<uint64_t>(reader->Int("bytes", 1, kMaxWeightsBytes));
  weights.sha256 = reader->String("sha256", kSha256HexBytes);
  const bool is_hex = weights.sha256.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (reader->ok() && (!is_hex || weights.sha256.size() != kSha256HexBytes)) {
    reader->Fail("sha256",
                 absl::StrCat("expected ", kSha256HexBytes, " digits of lower-case hex, got ",
                              json(weights.sha256).dump()));
  }
  return weights;
}

// Calls `read(key, fields)` for each field of an object of any names.
template <typename Read>
void ReadMap(base::ObjectReader* reader, const std::string& name, const Read& read) {
  const json& object = reader->Object(name);
  if (object.size() > kMaxMapEntries) reader->Fail(name, "too many entries");
  ReadSection(reader, name, [&](base::ObjectReader* fields) {
    for (const auto& field : object.items()) read(field.key(), fields);
  });
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

// Records an error unless the list `what` contains the name.
void ExpectOneOf(const std::vector<std::string>& list, const char* what, const std::string& name,
                 const std::string& key, base::ObjectReader* reader) {
  if (std::find(list.begin(), list.end(), name) != list.end()) return;
  reader->Fail(key, absl::StrCat("expected one of ", what, ", got ", json(name).dump()));
}

// The elements of an array of exactly `count` numbers, `each` says for what.
std::vector<double> ReadNumbers(base::ObjectReader* reader, const std::string& key,
                                std::size_t count, const char* each, double smallest,
                                double largest) {
  std::vector<double> numbers;
  for (const json& value : reader->Array(key, count)) {
    const std::string element = absl::StrCat(key, "[", numbers.size(), "]");
    numbers.push_back(value.is_number() ? value.get<double>() : std::nan(""));
    if (!(numbers.back() >= smallest && numbers.back() <= largest)) {
      reader->Fail(element, absl::StrCat("expected a number from ", smallest, " to ", largest,
                                         ", got ", base::Shown(value)));
    }
  }
  if (reader->ok() && numbers.size() != count) {
    reader->Fail(key,
                 absl::StrCat("expected ", count, " numbers (", each, "), got ", numbers.size()));
  }
  return numbers;
}

// Older checkpoints have no such field; the only class of their data in which bodies touch is
// "hug".
void ReadTouchingClasses(base::ObjectReader* reader, engine::ModelDescription* model) {
  const std::vector<std::string>& classes = model->classes;
  if (!reader->Has(kTouchingClasses)) {
    if (std::find(classes.begin(), classes.end(), "hug") != classes.end()) {
      model->touching_classes = {"hug"};
    }
    return;
  }
  model->touching_classes = reader->UniqueStrings(kTouchingClasses, kMaxClasses, kMaxNameBytes);
  for (const std::string& name : model->touching_classes) {
    ExpectOneOf(classes, "classes", name, kTouchingClasses, reader);
  }
}

// Calls `add(class, number)` for every class of an optional object of numbers in [0, most].
template <typename Add>
void ReadClassNumbers(base::ObjectReader* reader, const char* name,
                      const std::vector<std::string>& classes, double most, const Add& add) {
  if (!reader->Has(name)) return;
  ReadMap(reader, name, [&](const std::string& key, base::ObjectReader* fields) {
    ExpectOneOf(classes, "classes", key, name, reader);
    add(key, fields->Number(key, 0, most));
  });
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
  for (const json& value : reader->Array(kTrunkContacts, kMaxMapEntries)) {
    const std::string path = absl::StrCat(kTrunkContacts, "[", model->trunk_contacts.size(), "]");
    if (!value.is_object()) {
      return reader->Fail(path, absl::StrCat("expected an object, got ", base::Shown(value)));
    }
    base::ObjectReader fields(value, path);
    engine::TrunkContact contact;
    contact.interaction_class = fields.String("class", kMaxNameBytes);
    ExpectOneOf(model->classes, "classes", contact.interaction_class, "class", &fields);
    contact.hand = fields.String("hand", kMaxTextBytes);
    ExpectOneOf(model->skeleton.joint_names, "skeleton.joint_names", contact.hand, "hand", &fields);
    const auto along = [&](const char* axis) {
      return static_cast<float>(fields.Number(axis, -kFarthest, kFarthest));
    };
    contact.place = {along("across"), along("up"), along("forward")};
    reader->Update(fields.Finish());
    model->trunk_contacts.push_back(std::move(contact));
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

Feature ReadFeature(base::ObjectReader* fields, const std::vector<engine::LeaderFeature>& known,
                    std::set<std::string>* seen) {
  Feature feature;
  feature.name = fields->String("name", kMaxNameBytes);
  feature.mean = fields->Number("mean", -kMost, kMost);
  feature.deviation = fields->Number("deviation", kLeast, kMost);
  if (!seen->insert(feature.name).second) {
    fields->Fail("name", absl::StrCat(json(feature.name).dump(), " is repeated"));
  }
  std::string names;
  for (const engine::LeaderFeature& one : known) {
    if (one.name == feature.name) return feature;
    absl::StrAppend(&names, names.empty() ? "" : ", ", std::string(one.name));
  }
  fields->Fail("name",
               absl::StrCat("expected one of ", names, ", got ", json(feature.name).dump()));
  return feature;
}

// The statistics of the training leaders:
//   {"features": [{"name", "mean", "deviation"}, ...], "scale": 1.3}
// Every feature must be one of the skeleton; features may be absent.
engine::LeaderStatistics ReadLeaderStatistics(const motion::Skeleton& skeleton,
                                              base::ObjectReader* reader) {
  engine::LeaderStatistics statistics;
  const std::vector<engine::LeaderFeature> known = engine::LeaderFeatures(skeleton);
  std::set<std::string> seen;
  for (const json& item : reader->Array("features", known.size())) {
    base::ObjectReader fields(
        item, reader->PathOf(absl::StrCat("features[", statistics.features.size(), "]")));
    statistics.features.push_back(ReadFeature(&fields, known, &seen));
    reader->Update(fields.Finish());
  }
  if (reader->ok() && statistics.features.empty()) {
    reader->Fail("features", "expected at least one feature, got none");
  }
  statistics.scale = reader->Number("scale", kLeast, kMost);
  return statistics;
}

ordered_json LeaderStatisticsToJson(const engine::LeaderStatistics& statistics) {
  ordered_json features = ordered_json::array();
  for (const Feature& feature : statistics.features) {
    features.push_back(
        {{"name", feature.name}, {"mean", feature.mean}, {"deviation", feature.deviation}});
  }
  return {{"features", features}, {"scale", statistics.scale}};
}

constexpr char kRegressionNumbers[] = "two for each joint, three more";

void ReadCoefficients(base::ObjectReader* reader, std::size_t count, std::vector<double>* cosine,
                      std::vector<double>* sine) {
  *cosine = ReadNumbers(reader, "cosine", count, kRegressionNumbers, -kMost, kMost);
  *sine = ReadNumbers(reader, "sine", count, kRegressionNumbers, -kMost, kMost);
}

void ReadAngleRegression(base::ObjectReader* reader, std::size_t count,
                         engine::AngleRegression* regression) {
  regression->mean = ReadNumbers(reader, "mean", count, kRegressionNumbers, -kMost, kMost);
  regression->deviation =
      ReadNumbers(reader, "deviation", count, kRegressionNumbers, kLeast, kMost);
  ReadCoefficients(reader, count, &regression->cosine, &regression->sine);
}

engine::DirectionCorrection ReadCorrection(base::ObjectReader* reader, std::size_t count,
                                           std::size_t classes) {
  engine::DirectionCorrection correction;
  ReadAngleRegression(reader, count, &correction);
  const json& list = reader->Array("classes", classes);
  for (const json& value : list) {
    if (!value.is_object()) {
      reader->Fail("classes", absl::StrCat("expected objects, got ", base::Shown(value)));
      break;
    }
    base::ObjectReader item(
        value, reader->PathOf(absl::StrCat("classes[", correction.classes.size(), "]")));
    engine::ClassCoefficients& added = correction.classes.emplace_back();
    ReadCoefficients(&item, count, &added.cosine, &added.sine);
    reader->Update(item.Finish());
  }
  if (reader->ok() && list.size() != classes) {
    reader->Fail("classes", absl::StrCat("expected one object for each of the ", classes,
                                         " classes, got ", list.size()));
  }
  return correction;
}

ordered_json RegressionToJson(const engine::AngleRegression& regression) {
  return {{"mean", regression.mean},
          {"deviation", regression.deviation},
          {"cosine", regression.cosine},
          {"sine", regression.sine}};
}

// The regression of the partner's direction on the leader's motion; the field may be absent.
void ReadPartnerDirection(base::ObjectReader* manifest, engine::ModelDescription* model) {
  if (!manifest->ok() || !manifest->Has(kPartnerDirection)) return;
  ReadSection(manifest, kPartnerDirection, [&](base::ObjectReader* reader) {
    if (!model->skeleton.hips) {
      return manifest->Fail(kPartnerDirection,
                            "expected none for a skeleton without hips, got one");
    }
    const auto count = static_cast<std::size_t>(engine::DirectionFeatureCount(model->skeleton));
    engine::DirectionRegression& regression = model->partner_direction.emplace();
    ReadAngleRegression(reader, count, &regression);
    if (!reader->Has("correction")) return;
    ReadSection(reader, "correction", [&](base::ObjectReader* correction) {
      regression.correction = ReadCorrection(correction, count, model->classes.size());
    });
  });
}

ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression) {
  ordered_json object = RegressionToJson(regression);
  if (!regression.correction) return object;
  object["correction"] = RegressionToJson(*regression.correction);
  ordered_json& classes = object["correction"]["classes"] = ordered_json::array();
  for (const engine::ClassCoefficients& added : regression.correction->classes) {
    classes.push_back({{"cosine", added.cosine}, {"sine", added.sine}});
  }
  return object;
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
  if (reader.ok()) {
    absl::StatusOr<motion::SkeletonDocument> read =
        motion::ReadSkeleton(skeleton_object, "skeleton");
    reader.Update(read.status());
    if (read.ok()) skeleton = *std::move(read);
  }
  manifest.model.skeleton = std::move(skeleton.skeleton);
  // Older checkpoints lack some of these, and version 1 does not allow statistics.
  engine::ModelDescription& model = manifest.model;
  if (reader.Has(kBoneRatios)) {
    model.bone_ratios = ReadNumbers(&reader, kBoneRatios, model.skeleton.bones.size(),
                                    "one for each bone", kSmallestRatio, kLargestRatio);
  }
  if (reader.ok()) ReadTrunkContacts(&reader, &model);
  ReadDefaultSeeds(&reader, &model);
  if (manifest.format_version > 1 && reader.Has(kLeaderStatistics)) {
    ReadSection(&reader, kLeaderStatistics, [&](base::ObjectReader* fields) {
      model.leader_statistics = ReadLeaderStatistics(model.skeleton, fields);
    });
  }
  ReadPartnerDirection(&reader, &model);
  ReadSection(&reader, "generator", [&](base::ObjectReader* fields) {
    SetArchitecture(ReadArchitecture(manifest.format_version > 1, fields), &manifest);
  });
  manifest.parts = std::move(skeleton.parts);
  manifest.standardisation = ReadNamed(&reader, "standardisation", kStandardisationNames);
  ReadSection(&reader, "weights",
              [&](base::ObjectReader* fields) { manifest.weights = ReadWeightsFile(fields); });
  manifest.model.weights_sha256 = manifest.weights.sha256;
  manifest.git_revision = reader.String("git_revision", kMaxTextBytes);
  manifest.created = ReadTime(&reader, "created");
  ReadMap(&reader, "training", [&](const std::string& key, base::ObjectReader* fields) {
    manifest.training[key] = fields->String(key, kMaxTextBytes);
  });
  ReadMap(&reader, "metrics", [&](const std::string& key, base::ObjectReader* fields) {
    constexpr double kAny = std::numeric_limits<double>::max();
    manifest.metrics[key] = fields->Number(key, -kAny, kAny);
  });
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
