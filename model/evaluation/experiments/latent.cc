#include "model/evaluation/experiments/latent.h"

#include <torch/torch.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/network/batch.h"
#include "model/network/generator.h"
#include "model/network/parameters.h"
#include "model/network/sequence.h"
#include "model/training/sampler.h"

namespace duet::evaluation::experiments {
namespace {

// Sequences per batch: bounds memory.
constexpr size_t kBatch = 64;

std::vector<training::Example> Examples(const dataset::Dataset& dataset,
                                        const std::vector<int>& sequences, LatentLabels labels) {
  std::vector<training::Example> examples;
  for (const int index : sequences) {
    examples.push_back(CapturedExample(dataset, dataset.sequences[static_cast<size_t>(index)],
                                       training::StartKnowledge::kNone));
    std::vector<float>& weights = examples.back().weights;
    if (labels == LatentLabels::kNone) std::fill(weights.begin(), weights.end(), 0.0f);
  }
  return examples;
}

// [N, S 2 E]: the mean over each clip's own frames; without the outputs for padding.
torch::Tensor MeanOverFrames(const torch::Tensor& frames, const torch::Tensor& lengths) {
  const torch::Tensor mask =
      network::FrameMask(lengths, frames.size(0)).to(frames.dtype()).unsqueeze(2);
  return (frames * mask).sum(0) / lengths.to(frames.dtype()).unsqueeze(1);
}

metrics::FeatureSet Encode(const checkpoint::Manifest& manifest, network::Generator generator,
                           const dataset::Dataset& dataset,
                           const std::vector<training::Example>& examples) {
  torch::NoGradGuard no_grad;
  metrics::FeatureSet features;
  for (size_t first = 0; first < examples.size(); first += kBatch) {
    const auto begin = examples.begin() + static_cast<std::ptrdiff_t>(first);
    const size_t count = std::min(kBatch, examples.size() - first);
    const network::GeneratorInput input =
        training::MakeBatch(manifest, dataset, {begin, begin + static_cast<std::ptrdiff_t>(count)})
            .input;
    network::AppendRows(MeanOverFrames(generator->Encode(input), input.lengths), &features);
  }
  return features;
}

}  // namespace

absl::StatusOr<metrics::FeatureSet> LatentFeatures(const checkpoint::Checkpoint& checkpoint,
                                                   const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences,
                                                   LatentLabels labels) {
  DUET_RETURN_IF_ERROR(CheckModelFits(checkpoint.manifest.model, dataset));
  if (!std::holds_alternative<checkpoint::PaperArchitecture>(checkpoint.manifest.architecture)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "model ", checkpoint.manifest.model.name,
        ": expected a generator with encoders, whose latent space is shown, got one that samples"));
  }
  network::Generator generator(checkpoint.manifest);
  DUET_RETURN_IF_ERROR(network::LoadParameters(checkpoint, generator));
  generator->eval();
  // Converts LibTorch's exceptions to a status.
  try {
    return Encode(checkpoint.manifest, std::move(generator), dataset,
                  Examples(dataset, sequences, labels));
  } catch (const std::exception& error) {
    return absl::InternalError(absl::StrCat("the network failed: ", error.what()));
  }
}

}  // namespace duet::evaluation::experiments
