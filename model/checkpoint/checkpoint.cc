#include "model/checkpoint/checkpoint.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "model/base/file_io.h"
#include "model/base/sha256.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/checkpoint/architecture.h"

namespace duet::checkpoint {
namespace {

constexpr char kManifestFile[] = "manifest.json";

absl::Status CheckFile(const WeightsFile& expected, std::string_view weights) {
  if (weights.size() != expected.bytes) {
    const std::string message =
        absl::StrCat("weights: expected ", expected.bytes,
                     " bytes, as in the manifest's weights.bytes, got ", weights.size());
    return weights.size() < expected.bytes ? absl::DataLossError(message)
                                           : absl::InvalidArgumentError(message);
  }
  if (const std::string sha256 = base::Sha256Hex(weights); sha256 != expected.sha256) {
    return absl::DataLossError(absl::StrCat("weights: expected the SHA-256 ", expected.sha256,
                                            ", as in the manifest's weights.sha256, got ", sha256));
  }
  return absl::OkStatus();
}

std::string FormatNow() {
  return absl::FormatTime("%Y-%m-%dT%H:%M:%SZ", absl::Now(), absl::UTCTimeZone());
}

std::string ShapeText(const std::vector<int64_t>& shape) {
  return absl::StrCat("[", absl::StrJoin(shape, ", "), "]");
}

// Returns the tensors in the order of `specs`. Rejects missing and unknown tensors and wrong
// shapes.
absl::StatusOr<std::vector<Tensor>> Arrange(std::vector<Tensor> tensors,
                                            const std::vector<TensorSpec>& specs) {
  std::map<std::string, Tensor> by_name;
  for (Tensor& tensor : tensors) {
    std::string name = tensor.name;
    by_name.emplace(std::move(name), std::move(tensor));
  }
  std::vector<Tensor> arranged;
  for (const TensorSpec& spec : specs) {
    const auto it = by_name.find(spec.name);
    if (it == by_name.end()) {
      return absl::InvalidArgumentError(absl::StrCat("weights: expected a tensor \"", spec.name,
                                                     "\" of the shape ", ShapeText(spec.shape),
                                                     ", got none"));
    }
    if (it->second.shape != spec.shape) {
      return absl::InvalidArgumentError(absl::StrCat(
          "weights: tensor \"", spec.name, "\": expected the shape ", ShapeText(spec.shape),
          ", as the manifest declares, got ", ShapeText(it->second.shape)));
    }
    arranged.push_back(std::move(it->second));
    by_name.erase(it);
  }
  if (by_name.empty()) return arranged;
  return absl::InvalidArgumentError(
      absl::StrCat("weights: unknown tensor ", base::Quoted(by_name.begin()->first)));
}

// Moves the critic's tensors out of `tensors`.
std::vector<Tensor> TakeCritic(std::vector<Tensor>* tensors) {
  const auto critic = std::stable_partition(tensors->begin(), tensors->end(), [](const Tensor& t) {
    return t.name.rfind(kCriticPrefix, 0) != 0;
  });
  std::vector<Tensor> taken(std::make_move_iterator(critic),
                            std::make_move_iterator(tensors->end()));
  tensors->erase(critic, tensors->end());
  return taken;
}

}  // namespace

absl::StatusOr<Checkpoint> ParseCheckpoint(std::string_view manifest_json,
                                           std::string_view weights) {
  DUET_TRY(Manifest manifest, ParseManifest(manifest_json));
  DUET_RETURN_IF_ERROR(CheckFile(manifest.weights, weights));
  DUET_TRY(std::vector<Tensor> tensors, ParseSafetensors(weights));
  std::vector<Tensor> critic = TakeCritic(&tensors);
  if (!critic.empty()) {
    DUET_TRY(critic, Arrange(std::move(critic), CriticTensors(manifest.model)));
  }
  DUET_TRY(tensors, Arrange(std::move(tensors), ExpectedTensors(manifest)));
  return Checkpoint{std::move(manifest), std::move(tensors), std::move(critic)};
}

absl::StatusOr<Checkpoint> ReadCheckpoint(const std::filesystem::path& folder) {
  DUET_TRY(const base::Folder files, base::Folder::Open(folder));
  DUET_TRY(const std::string text, files.Read(kManifestFile, kMaxManifestBytes));
  DUET_TRY(const Manifest manifest, ParseManifest(text));
  // A larger file is rejected before it is read.
  DUET_TRY(const std::string weights,
           files.Read(manifest.weights.file, static_cast<std::size_t>(manifest.weights.bytes)));
  return ParseCheckpoint(text, weights);
}

absl::Status CheckManifest(Manifest manifest) {
  DUET_RETURN_IF_ERROR(Validate(manifest.model.skeleton));
  DUET_RETURN_IF_ERROR(Validate(manifest.parts, manifest.model.skeleton));
  manifest.weights.bytes = 1;
  manifest.weights.sha256 = base::Sha256Hex("");
  manifest.created = FormatNow();
  return ParseManifest(SerializeManifest(manifest)).status();
}

absl::Status WriteCheckpoint(const std::filesystem::path& folder, Checkpoint checkpoint) {
  Manifest& manifest = checkpoint.manifest;
  DUET_RETURN_IF_ERROR(Validate(manifest.model.skeleton));
  DUET_RETURN_IF_ERROR(Validate(manifest.parts, manifest.model.skeleton));
  std::vector<Tensor> tensors = std::move(checkpoint.tensors);
  std::move(checkpoint.critic.begin(), checkpoint.critic.end(), std::back_inserter(tensors));
  const std::string weights = SerializeSafetensors(tensors, {{"format", "pt"}});
  manifest.weights.bytes = weights.size();
  manifest.weights.sha256 = base::Sha256Hex(weights);
  if (manifest.created.empty()) manifest.created = FormatNow();
  const std::string text = SerializeManifest(manifest);
  // Content that cannot be read back must not be written.
  DUET_RETURN_IF_ERROR(ParseCheckpoint(text, weights).status());
  return base::WriteFolder(folder, {{manifest.weights.file, weights}, {kManifestFile, text}});
}

}  // namespace duet::checkpoint
