#include "model/evaluation/judge/latent.h"

#include <torch/torch.h>

#include <algorithm>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/network/batch.h"
#include "model/network/generator.h"
#include "model/network/parameters.h"
#include "model/network/recurrent.h"
#include "model/training/sampler.h"

namespace duet::evaluation::judge {

absl::StatusOr<metrics::FeatureSet> LatentFeatures(const checkpoint::Checkpoint& checkpoint,
                                                   const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences,
                                                   bool labelled) {
  constexpr size_t kBatch = 64;  // bounds memory
  const checkpoint::Manifest& manifest = checkpoint.manifest;
  if (!std::holds_alternative<checkpoint::PaperArchitecture>(manifest.architecture) ||
      manifest.model.classes != dataset.classes ||
      manifest.model.skeleton.joint_names != dataset.skeleton.joint_names) {
    return absl::InvalidArgumentError(
        absl::StrCat("model ", manifest.model.name,
                     ": expected the paper's generator, whose latent space is shown, with the "
                     "data's classes and joints, got another"));
  }
  torch::NoGradGuard no_grad;
  network::Generator generator(manifest);
  DUET_RETURN_IF_ERROR(network::LoadParameters(checkpoint, generator));
  generator->eval();
  metrics::FeatureSet features;
  for (size_t first = 0; first < sequences.size(); first += kBatch) {
    std::vector<training::Example> examples;
    for (size_t i = first; i < std::min(sequences.size(), first + kBatch); ++i) {
      examples.push_back(CapturedExample(dataset,
                                         dataset.sequences[static_cast<size_t>(sequences[i])],
                                         training::StartKnowledge::kNone));
      std::vector<float>& weights = examples.back().weights;
      if (!labelled) std::fill(weights.begin(), weights.end(), 0.0f);
    }
    const network::GeneratorInput input = training::MakeBatch(manifest, dataset, examples).input;
    // The mean over each clip's own frames; without the outputs for padding.
    const torch::Tensor frames = generator->Encode(input);
    const torch::Tensor mask =
        network::FrameMask(input.lengths, frames.size(0)).to(frames.dtype()).unsqueeze(2);
    network::AppendRows((frames * mask).sum(0) / input.lengths.to(frames.dtype()).unsqueeze(1),
                        &features);
  }
  return features;
}

}  // namespace duet::evaluation::judge
