#include "tests/fuzz/checkpoint_targets.h"

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "model/base/sha256.h"
#include "model/checkpoint/checkpoint.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {
namespace {

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;
constexpr auto kDataLoss = absl::StatusCode::kDataLoss;

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
  return CheckRefusal(checkpoint::ParseCheckpoint(text, Std(parts[1])).status(),
                      {kInvalidArgument, kDataLoss});
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
