// Clips a second that the trainer learns from: L1 only, the paper's sizes, one thread. Its peer is
// training_eager.py, the same network and batch in eager PyTorch; compare_training.sh runs both.
#include <benchmark/benchmark.h>
#include <torch/torch.h>

#include "model/network/generator.h"
#include "model/network/losses.h"
#include "model/training/optimiser.h"

namespace {

constexpr int64_t kBatch = 16, kFrames = 45, kJoints = 15;

duet::checkpoint::Manifest PaperManifest() {
  duet::checkpoint::Manifest manifest;
  manifest.model.name = "benchmark";
  manifest.model.version = 1;
  manifest.model.skeleton = duet::motion::SbuSkeleton();
  manifest.parts = duet::motion::SbuParts();
  auto& paper = manifest.architecture.emplace<duet::checkpoint::PaperArchitecture>();
  paper.slice_features = 50;
  paper.encoder_hidden = 40;
  paper.attention = 128;
  manifest.model.classes = {"kick", "push", "shake_hands", "hug", "exchange_object", "punch"};
  manifest.model.frame_rate_hz = 15;
  manifest.model.window_frames = static_cast<int>(kFrames);
  return manifest;
}

void BM_TrainingStep(benchmark::State& state) {
  torch::set_num_threads(static_cast<int>(state.range(0)));
  torch::manual_seed(0);
  const duet::checkpoint::Manifest manifest = PaperManifest();
  duet::network::Generator generator(manifest);
  duet::training::TrainingOptions::Optimiser options;
  options.schedule = "constant";
  duet::training::Optimiser optimiser(options, generator->parameters(), 1);
  duet::network::GeneratorInput input;
  input.leader = torch::randn({kBatch, kFrames, 3 * kJoints});
  input.labels = torch::zeros({kBatch, kFrames, 6});
  input.lengths = torch::full({kBatch}, kFrames, torch::kInt64);
  const torch::Tensor target = torch::randn({kBatch, kFrames, 3 * kJoints});
  for (auto _ : state) {
    duet::network::L1Loss(generator->forward(input), target, input.lengths).backward();
    optimiser.Step(0);
  }
  state.counters["clips/s"] =
      benchmark::Counter(kBatch, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_TrainingStep)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
