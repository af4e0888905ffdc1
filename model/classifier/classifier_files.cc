#include "model/classifier/classifier_files.h"

#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/base/strict_json.h"
#include "model/motion/motion_limits.h"
#include "model/motion/skeleton_json.h"
#include "nlohmann/json.hpp"

namespace duet::classifier {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kFormat = 1;
constexpr std::size_t kMaxJsonBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxWeightBytes = std::size_t{256} << 20;
constexpr std::size_t kMaxClasses = 1000;
constexpr int kMaxDepth = 6;
constexpr char kJsonFile[] = "judge.json";
constexpr char kWeightsFile[] = "weights.safetensors";

// The file's skeleton requires parts; the classifier does not use them.
std::vector<motion::BodyPart> WholeBody(const motion::Skeleton& skeleton) {
  motion::BodyPart body{"body", {}};
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) body.joints.push_back(joint);
  return {body};
}

absl::Status InFile(const char* file, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(file, ": ", status.message()));
}

struct Described {
  ClassifierParts parts;
  std::string weights_sha256;
};

absl::StatusOr<Described> Parse(const std::string& text) {
  const absl::StatusOr<nlohmann::json> json = base::ParseStrictJson(text, kMaxDepth);
  if (!json.ok()) return json.status();
  base::ObjectReader reader(*json, "");
  Described described;
  ClassifierParts& parts = described.parts;
  reader.Int("format", kFormat, kFormat);
  parts.classes = reader.Strings("classes", kMaxClasses);
  absl::StatusOr<motion::SkeletonDocument> skeleton =
      motion::ReadSkeleton(reader.Object("skeleton"), "skeleton");
  reader.Update(skeleton.status());
  if (skeleton.ok()) parts.skeleton = std::move(skeleton->skeleton);
  parts.frame_rate_hz = reader.Number("frame_rate_hz", 1, 1000);
  parts.window_frames = static_cast<int>(reader.Int("window_frames", 1, 100000));
  parts.hidden = static_cast<int>(reader.Int("hidden", 1, 10000));
  parts.networks = static_cast<int>(reader.Int("networks", 1, 100));
  described.weights_sha256 = reader.String("weights_sha256", 64);
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  return described;
}

}  // namespace

absl::StatusOr<StoredClassifier> ParseClassifier(const std::string& json,
                                                 const std::string& weights) {
  absl::StatusOr<Described> described = Parse(json);
  if (!described.ok()) return InFile(kJsonFile, described.status());
  if (base::Sha256Hex(weights) != described->weights_sha256) {
    return absl::DataLossError(
        absl::StrCat(kWeightsFile, ": its SHA-256 is not the one in ", kJsonFile));
  }
  absl::StatusOr<std::vector<checkpoint::Tensor>> tensors = checkpoint::ParseSafetensors(weights);
  if (!tensors.ok()) return InFile(kWeightsFile, tensors.status());
  described->parts.tensors = *std::move(tensors);
  absl::StatusOr<Classifier> classifier = Classifier::Create(std::move(described->parts));
  if (!classifier.ok()) return InFile(kWeightsFile, classifier.status());
  return StoredClassifier{*std::move(classifier), base::Sha256Hex(json)};
}

absl::StatusOr<StoredClassifier> ReadClassifier(const fs::path& folder) {
  const absl::StatusOr<std::string> json =
      base::ReadFile(folder / kJsonFile, kMaxJsonBytes, "a judge");
  if (!json.ok()) return json.status();
  const absl::StatusOr<std::string> weights =
      base::ReadFile(folder / kWeightsFile, kMaxWeightBytes, "a judge's weights");
  if (!weights.ok()) return weights.status();
  absl::StatusOr<StoredClassifier> stored = ParseClassifier(*json, *weights);
  if (stored.ok()) return stored;
  return absl::Status(stored.status().code(),
                      absl::StrCat(folder.string(), "/", stored.status().message()));
}

absl::Status WriteClassifier(const fs::path& folder, const ClassifierParts& parts) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return absl::PermissionDeniedError(absl::StrCat(folder.string(), ": ", error.message()));
  }
  const std::string weights = checkpoint::SerializeSafetensors(parts.tensors);
  const nlohmann::ordered_json json = {
      {"format", kFormat},
      {"classes", parts.classes},
      {"skeleton", motion::SkeletonToJson(parts.skeleton, WholeBody(parts.skeleton))},
      {"frame_rate_hz", parts.frame_rate_hz},
      {"window_frames", parts.window_frames},
      {"hidden", parts.hidden},
      {"networks", parts.networks},
      {"weights_sha256", base::Sha256Hex(weights)}};
  absl::Status status = base::WriteFile(folder / kWeightsFile, weights);
  if (!status.ok()) return status;
  return base::WriteFile(folder / kJsonFile, json.dump(2) + "\n");
}

}  // namespace duet::classifier
