#include "model/evaluation/program/dance_variants.h"

#include <utility>

#include "absl/strings/numbers.h"
#include "model/base/status_macros.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace duet::evaluation::program {
namespace {

constexpr int kCandidates = 4;

struct Change {
  std::string name;
  engine::ModelDescription model;
  bool clean_up = true;
  experiments::AskedSamples asked;
};

// The noise of training, in the varieties that the checkpoint knows. 1 if it stores all of it.
float VarietyOfTraining(const checkpoint::Manifest& manifest) {
  const auto share = manifest.training.find("flow.noise_share");
  float stored = 1;
  if (share == manifest.training.end() || !absl::SimpleAtof(share->second, &stored)) return 1;
  return stored > 0 ? 1 / stored : 1;
}

std::vector<Change> Changes(const checkpoint::Manifest& manifest,
                            const experiments::AskedSamples& asked) {
  const Change served = {"as served", manifest.model, true, asked};
  std::vector<Change> changes = {served};
  const auto add = [&](const char* name) -> Change& {
    changes.push_back(served);
    changes.back().name = name;
    return changes.back();
  };
  add("labels do not choose turns").model.turning_classes.clear();
  add("no steps in time").model.steps_in_time = false;
  add("hips are not raised").model.hip_height = 0;
  add("no clean-up").clean_up = false;
  add("four candidates").asked.candidates = kCandidates;
  const float variety = VarietyOfTraining(manifest);
  if (variety != 1) add("all the noise of training").asked.variety *= variety;
  return changes;
}

}  // namespace

absl::StatusOr<std::vector<DanceVariant>> DanceVariants(const checkpoint::Checkpoint& checkpoint,
                                                        const experiments::AskedSamples& asked) {
  std::vector<DanceVariant> variants;
  for (Change& change : Changes(checkpoint.manifest, asked)) {
    checkpoint::Checkpoint changed = checkpoint;
    changed.manifest.model = std::move(change.model);
    DUET_TRY(SharedSynthesizer synthesizer,
             torch_engine::MakeTorchSynthesizer(changed, {true, true, change.clean_up}));
    variants.push_back({std::move(change.name), std::move(synthesizer), change.asked});
  }
  return variants;
}

}  // namespace duet::evaluation::program
