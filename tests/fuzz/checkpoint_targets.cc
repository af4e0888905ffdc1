#include "tests/fuzz/checkpoint_targets.h"

#include <cmath>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "model/base/sha256.h"
#include "model/checkpoint/checkpoint.h"
#include "model/classifier/classifier_files.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json.hpp"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {
namespace {

constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;
constexpr auto kDataLoss = absl::StatusCode::kDataLoss;

// Two frames of people who stand in one point: a classifier takes them as they are.
motion::ClipPair PairOf(const motion::Skeleton& skeleton) {
  motion::Clip clip;
  clip.joint_names = skeleton.joint_names;
  clip.frame_rate_hz = 30;
  clip.poses = motion::Poses(2, skeleton.joint_count());
  return {clip, clip};
}

}  // namespace

Broken Checkpoint(absl::string_view input) {
  const std::vector<absl::string_view> parts = Parts(input, 2);
  absl::StatusOr<checkpoint::Manifest> manifest = checkpoint::ParseManifest(Std(parts[0]));
  if (!manifest.ok()) return CheckRefusal(manifest.status());
  // As if whoever changed the weights had fitted the digest: nothing else would be looked at.
  manifest->weights.bytes = parts[1].size();
  manifest->weights.sha256 = base::Sha256Hex(Std(parts[1]));
  const std::string text = SerializeManifest(*manifest);
  if (manifest->weights.bytes > 0) {
    const absl::Status again = checkpoint::ParseManifest(text).status();
    if (!again.ok()) return absl::StrCat("a manifest is not read again: ", again.ToString());
  }
  if (ModelCard(*manifest).empty()) return "a model has no card";
  return CheckRefusal(checkpoint::ParseCheckpoint(text, Std(parts[1])).status(),
                      {kInvalidArgument, kDataLoss});
}

Broken Judge(absl::string_view input) {
  const std::vector<absl::string_view> parts = Parts(input, 2);
  const std::string weights(Std(parts[1]));
  nlohmann::json json = nlohmann::json::parse(parts[0], nullptr, false);
  if (json.is_object()) json["weights_sha256"] = base::Sha256Hex(weights);
  const std::string text =
      json.is_object() ? json.dump(-1, ' ', true, kReplace) : std::string(Std(parts[0]));
  const auto stored = classifier::ParseClassifier(text, weights);
  if (!stored.ok()) return CheckRefusal(stored.status(), {kInvalidArgument, kDataLoss});
  float sum = 0;
  const classifier::Classifier& judge = stored->classifier;
  for (const float probability : judge.Probabilities(PairOf(judge.parts().skeleton))) {
    sum += probability;
  }
  return std::abs(sum - 1) < 1e-3f ? "" : absl::StrCat("probabilities add up to ", sum);
}

Broken Safetensors(absl::string_view input) {
  const absl::StatusOr<std::vector<checkpoint::Tensor>> tensors =
      checkpoint::ParseSafetensors(Std(input));
  if (!tensors.ok()) return CheckRefusal(tensors.status(), {kInvalidArgument, kDataLoss});
  const auto again = checkpoint::ParseSafetensors(checkpoint::SerializeSafetensors(*tensors));
  if (!again.ok()) return absl::StrCat("tensors are not read again: ", again.status().ToString());
  return again->size() == tensors->size() ? "" : "tensors are lost";
}

}  // namespace duet::fuzz
