#include "model/checkpoint/manifest.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/time/time.h"
#include "model/base/strict_json.h"
#include "model/checkpoint/json_fields.h"
#include "model/engine/windows.h"
#include "model/motion/motion_limits.h"
#include "model/motion/skeleton_json.h"

namespace duet::checkpoint {
namespace {

using engine::ModelDescription;
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
// Of measurements of people: far above any person, and low enough that squares and sums cannot
// overflow.
constexpr double kMost = 1e6, kLeast = 1e-6;
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

// A text that `is_valid` accepts; `expected` describes it.
template <typename IsValid>
void DeclareText(Fields* fields, const std::string& name, std::size_t max_bytes,
                 const std::string& expected, const IsValid& is_valid, std::string* value) {
  fields->Text(name, max_bytes, value);
  if (fields->ReadsWell() && !is_valid(*value)) {
    fields->Fail(name, absl::StrCat("expected ", expected, ", got ", json(*value).dump()));
  }
}

void DeclareName(Fields* fields, const std::string& name, std::string* value) {
  DeclareText(fields, name, kMaxTextBytes, kPlainName, IsPlainName, value);
}

void Declare(Fields* fields, WeightsFile* weights) {
  DeclareName(fields, "file", &weights->file);
  fields->Int("bytes", 1, kMaxWeightsBytes, &weights->bytes);
  const auto is_sha256 = [](const std::string& text) {
    return text.size() == kSha256HexBytes &&
           text.find_first_not_of("0123456789abcdef") == std::string::npos;
  };
  DeclareText(fields, "sha256", kSha256HexBytes,
              absl::StrCat(kSha256HexBytes, " digits of lower-case hex"), is_sha256,
              &weights->sha256);
}

void DeclareTime(Fields* fields, const std::string& name, std::string* value) {
  const auto is_time = [](const std::string& text) {
    absl::Time time;
    std::string problem;
    return absl::ParseTime(absl::RFC3339_full, text, &time, &problem);
  };
  DeclareText(fields, name, kMaxNameBytes, "a time as in RFC 3339", is_time, value);
}

// An object with any names.
template <typename Value, typename DeclareValue>
void DeclareMap(Fields* fields, const std::string& name, std::map<std::string, Value>* values,
                const DeclareValue& declare) {
  for (const std::string& key : fields->NamesIn(name, kMaxMapEntries)) (*values)[key];
  fields->Section(name, [&] {
    for (auto& [key, value] : *values) declare(key, &value);
  });
}

// Records an error unless the list `what` contains the name.
void ExpectOneOf(const std::vector<std::string>& list, const char* what, const std::string& name,
                 const std::string& key, Fields* fields) {
  if (!fields->ReadsWell() || std::find(list.begin(), list.end(), name) != list.end()) return;
  fields->Fail(key, absl::StrCat("expected one of ", what, ", got ", json(name).dump()));
}

// Older checkpoints have no such field; the only class of their data in which bodies touch is
// "hug".
void DeclareTouchingClasses(Fields* fields, int format_version, ModelDescription* model) {
  constexpr char kName[] = "touching_classes";
  const std::vector<std::string>& classes = model->classes;
  if (fields->Optional(kName, format_version > 1)) {
    fields->Texts(kName, kMaxClasses, kMaxNameBytes, &model->touching_classes);
    for (const std::string& name : model->touching_classes) {
      ExpectOneOf(classes, "classes", name, kName, fields);
    }
  } else if (std::find(classes.begin(), classes.end(), "hug") != classes.end()) {
    model->touching_classes = {"hug"};
  }
}

// An optional object with a number in [0, most] for some of the classes.
template <typename Entry>
void DeclareClassNumbers(Fields* fields, const char* name, const ModelDescription& model,
                         double most, double Entry::*number, std::vector<Entry>* entries) {
  if (!fields->Optional(name, !entries->empty())) return;
  for (const std::string& key : fields->NamesIn(name, kMaxMapEntries)) {
    ExpectOneOf(model.classes, "classes", key, name, fields);
    entries->push_back({key, 0});
  }
  fields->Section(name, [&] {
    for (Entry& entry : *entries) {
      fields->Number(entry.interaction_class, 0, most, &(entry.*number));
    }
  });
}

void DeclareTrunkContacts(Fields* fields, ModelDescription* model) {
  constexpr double kFarthest = 2;  // lengths of the trunk
  constexpr char kName[] = "trunk_contacts";
  if (!fields->Optional(kName, !model->trunk_contacts.empty())) return;
  fields->List(kName, kMaxMapEntries, &model->trunk_contacts, [&](engine::TrunkContact* contact) {
    fields->Text("class", kMaxNameBytes, &contact->interaction_class);
    ExpectOneOf(model->classes, "classes", contact->interaction_class, "class", fields);
    fields->Text("hand", kMaxTextBytes, &contact->hand);
    ExpectOneOf(model->skeleton.joint_names, "skeleton.joint_names", contact->hand, "hand", fields);
    fields->Number("across", -kFarthest, kFarthest, &contact->place.x);
    fields->Number("up", -kFarthest, kFarthest, &contact->place.y);
    fields->Number("forward", -kFarthest, kFarthest, &contact->place.z);
  });
}

void DeclareDefaultSeeds(Fields* fields, std::vector<uint64_t>* seeds) {
  constexpr char kName[] = "default_seeds";
  if (!fields->Optional(kName, !seeds->empty())) return;
  fields->Write(kName, *seeds);
  if (fields->reader() == nullptr) return;
  for (const json& value : fields->reader()->Array(kName, engine::kMostDefaultSeeds)) {
    if (!value.is_number_unsigned()) {
      return fields->Fail(absl::StrCat(kName, "[", seeds->size(), "]"),
                          absl::StrCat("expected a whole number from 0, got ", value.dump()));
    }
    seeds->push_back(value.get<uint64_t>());
  }
}

// The statistics of the training leaders. Every feature must be one of the skeleton; features may
// be absent.
void Declare(Fields* fields, const motion::Skeleton& skeleton,
             engine::LeaderStatistics* statistics) {
  std::vector<std::string> known;
  for (const engine::LeaderFeature& feature : engine::LeaderFeatures(skeleton)) {
    known.emplace_back(feature.name);
  }
  std::set<std::string> seen;
  const auto declare = [&](engine::LeaderStatistics::Feature* feature) {
    fields->Text("name", kMaxNameBytes, &feature->name);
    fields->Number("mean", -kMost, kMost, &feature->mean);
    fields->Number("deviation", kLeast, kMost, &feature->deviation);
    if (fields->ReadsWell() && !seen.insert(feature->name).second) {
      fields->Fail("name", absl::StrCat(json(feature->name).dump(), " is repeated"));
    }
    ExpectOneOf(known, absl::StrJoin(known, ", ").c_str(), feature->name, "name", fields);
  };
  fields->List("features", known.size(), &statistics->features, declare);
  if (fields->ReadsWell() && statistics->features.empty()) {
    fields->Fail("features", "expected at least one feature, got none");
  }
  fields->Number("scale", kLeast, kMost, &statistics->scale);
}

constexpr char kRegressionNumbers[] = "two for each joint, three more";

template <typename Coefficients>
void DeclareCoefficients(Fields* fields, std::size_t count, Coefficients* coefficients) {
  fields->Numbers("cosine", count, kRegressionNumbers, -kMost, kMost, &coefficients->cosine);
  fields->Numbers("sine", count, kRegressionNumbers, -kMost, kMost, &coefficients->sine);
}

void Declare(Fields* fields, std::size_t count, engine::AngleRegression* regression) {
  fields->Numbers("mean", count, kRegressionNumbers, -kMost, kMost, &regression->mean);
  fields->Numbers("deviation", count, kRegressionNumbers, kLeast, kMost, &regression->deviation);
  DeclareCoefficients(fields, count, regression);
}

// The regression of the partner's direction on the leader's motion; the field may be absent.
void DeclarePartnerDirection(Fields* fields, ModelDescription* model) {
  constexpr char kName[] = "partner_direction";
  if (!fields->Optional(kName, model->partner_direction.has_value())) return;
  if (fields->ReadsWell() && !model->skeleton.hips) {
    return fields->Fail(kName, "expected none for a skeleton without hips, got one");
  }
  if (!model->partner_direction) model->partner_direction.emplace();
  engine::DirectionRegression& regression = *model->partner_direction;
  const auto count = static_cast<std::size_t>(engine::DirectionFeatureCount(model->skeleton));
  const std::size_t classes = model->classes.size();
  fields->Section(kName, [&] {
    Declare(fields, count, &regression);
    if (!fields->Optional("correction", regression.correction.has_value())) return;
    if (!regression.correction) regression.correction.emplace();
    std::vector<engine::ClassCoefficients>& added = regression.correction->classes;
    fields->Section("correction", [&] {
      Declare(fields, count, &*regression.correction);
      fields->List("classes", classes, &added, [&](engine::ClassCoefficients* one) {
        DeclareCoefficients(fields, count, one);
      });
      if (fields->ReadsWell() && added.size() != classes) {
        fields->Fail("classes", absl::StrCat("expected one object for each of the ", classes,
                                             " classes, got ", added.size()));
      }
    });
  });
}

void DeclareSkeleton(Fields* fields, Manifest* manifest) {
  constexpr char kName[] = "skeleton";
  base::ObjectReader* const reader = fields->reader();
  if (reader == nullptr) {
    return fields->Write(kName, motion::SkeletonToJson(manifest->model.skeleton, manifest->parts));
  }
  const json& object = reader->Object(kName);
  if (!reader->ok()) return;
  absl::StatusOr<motion::SkeletonDocument> read = motion::ReadSkeleton(object, kName);
  if (!read.ok()) return reader->Update(read.status());
  manifest->model.skeleton = std::move(read->skeleton);
  manifest->parts = std::move(read->parts);
}

void DeclareGenerator(Fields* fields, Manifest* manifest) {
  const bool has_kind = manifest->format_version > 1;
  if (base::ObjectReader* const reader = fields->reader()) {
    return ReadSection(reader, "generator", [&](base::ObjectReader* generator) {
      SetArchitecture(ReadArchitecture(has_kind, generator), manifest);
    });
  }
  ordered_json object = ToJson(manifest->architecture);
  if (!has_kind) object.erase(kArchitectureKind);
  fields->Write("generator", object);
}

// Fields that older checkpoints lack.
void DeclareLaterFields(Fields* fields, int format_version, ModelDescription* model) {
  constexpr double kFarthestHands = 1, kTurnedRound = 180;    // metres, degrees
  constexpr double kSmallestRatio = 0.1, kLargestRatio = 10;  // of followers' bones to leaders'
  DeclareTouchingClasses(fields, format_version, model);
  DeclareClassNumbers(fields, "hand_contacts", *model, kFarthestHands, &engine::HandContact::metres,
                      &model->hand_contacts);
  DeclareTrunkContacts(fields, model);
  DeclareClassNumbers(fields, "facing_classes", *model, kTurnedRound, &engine::FacingClass::degrees,
                      &model->facing_classes);
  if (fields->Optional("bone_ratios", !model->bone_ratios.empty())) {
    fields->Numbers("bone_ratios", model->skeleton.bones.size(), "one for each bone",
                    kSmallestRatio, kLargestRatio, &model->bone_ratios);
  }
  DeclareDefaultSeeds(fields, &model->default_seeds);
  if (fields->Optional("terms", !model->terms.empty())) {
    fields->Text("terms", kMaxTextBytes, &model->terms);
  }
  if (fields->Optional("lookahead_frames", model->lookahead_frames > 0)) {
    // Windows share their settled frames and the lookahead, and must still advance.
    const int most = model->window_frames - engine::SettledOverlap(model->window_frames) - 1;
    fields->Int("lookahead_frames", 0, std::max(0, most), &model->lookahead_frames);
  }
  fields->OptionalBool("free_for_all_uses", &model->free_for_all_uses);
  // Version 1 does not allow statistics: they are left unread there, and so rejected.
  const bool is_allowed = format_version > 1 || fields->reader() == nullptr;
  if (is_allowed && fields->Optional("leader_statistics", model->leader_statistics.has_value())) {
    if (!model->leader_statistics) model->leader_statistics.emplace();
    fields->Section("leader_statistics",
                    [&] { Declare(fields, model->skeleton, &*model->leader_statistics); });
  }
  DeclarePartnerDirection(fields, model);
}

void Declare(Fields* fields, Manifest* manifest) {
  constexpr double kAny = std::numeric_limits<double>::max();
  ModelDescription* const model = &manifest->model;
  // First, because only the first problem is reported and a newer format may differ in any field.
  fields->Int("format_version", 1, kCheckpointFormatVersion, &manifest->format_version);
  DeclareName(fields, "name", &model->name);
  fields->Int("version", 1, std::numeric_limits<int>::max(), &model->version);
  fields->Text("description", kMaxTextBytes, &model->description);
  DeclareTime(fields, "created", &manifest->created);
  fields->Text("git_revision", kMaxTextBytes, &manifest->git_revision);
  fields->Number("frame_rate_hz", 1, motion::kMaxServedFrameRateHz, &model->frame_rate_hz);
  fields->Int("window_frames", 2, kMaxWindowFrames, &model->window_frames);
  fields->Texts("classes", kMaxClasses, kMaxNameBytes, &model->classes);
  if (fields->ReadsWell() && model->classes.empty()) {
    fields->Fail("classes", "expected at least one class, got none");
  }
  fields->Choice("standardisation", kStandardisationNames, &manifest->standardisation);
  DeclareSkeleton(fields, manifest);
  DeclareGenerator(fields, manifest);
  fields->Section("weights", [&] { Declare(fields, &manifest->weights); });
  DeclareMap(
      fields, "training", &manifest->training,
      [&](const std::string& key, std::string* value) { fields->Text(key, kMaxTextBytes, value); });
  DeclareMap(fields, "metrics", &manifest->metrics, [&](const std::string& key, double* value) {
    fields->Number(key, -kAny, kAny, value);
  });
  DeclareLaterFields(fields, manifest->format_version, model);
}

absl::StatusOr<Manifest> ReadManifest(const json& root) {
  base::ObjectReader reader(root, "");
  for (const char* field : kFormerFields) reader.Ignore(field);
  Fields fields(&reader);
  Manifest manifest;
  Declare(&fields, &manifest);
  manifest.model.weights_sha256 = manifest.weights.sha256;
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
  Manifest declared = manifest;
  ordered_json root;
  Fields fields(&root);
  Declare(&fields, &declared);
  return root.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace duet::checkpoint
