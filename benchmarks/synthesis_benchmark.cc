// How fast the engine answers: frames a second by batch, and a long clip from end to end.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "model/checkpoints/embedded.h"
#include "model/engine/clip_synthesis.h"
#include "model/network/flow_generator.h"
#include "model/network/parameters.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace {

constexpr int kLongFrames = 18000;  // 10 minutes at 30 frames a second
constexpr double kLongRateHz = 30;

const duet::engine::Synthesizer& Model() {
  static const auto* const kModels = [] {
    duet::torch_engine::SetTorchThreads(1);
    auto loaded = duet::torch_engine::LoadEmbeddedSynthesizers();
    if (!loaded.ok()) {
      std::cerr << loaded.status().message() << "\n";
      std::exit(1);
    }
    return new std::vector<std::unique_ptr<duet::engine::Synthesizer>>(*std::move(loaded));
  }();
  return *kModels->front();
}

// A sampling generator of the size that trains by default, for the same data; its weights, which
// its speed does not depend on, are random.
const duet::engine::Synthesizer& SamplingModel() {
  static const auto* const kModel = [] {
    duet::torch_engine::SetTorchThreads(1);
    const auto embedded = duet::embedded::EmbeddedCheckpoints().front();
    auto manifest = duet::checkpoint::ParseManifest(embedded.manifest);
    manifest->flow.emplace();
    const duet::network::FlowGenerator generator(*manifest);
    auto tensors = duet::network::StoreParameters(*manifest, generator);
    auto made = duet::torch_engine::MakeTorchSynthesizer({*manifest, std::move(tensors)});
    if (!made.ok()) {
      std::cerr << made.status().message() << "\n";
      std::exit(1);
    }
    return made->release();
  }();
  return *kModel;
}

// A made-up person who sways: speed does not depend on what the leader does.
duet::motion::Poses Leader(int frames) {
  const int joints = Model().description().skeleton.joint_count();
  duet::motion::Poses leader(frames, joints);
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < joints; ++j) {
      const float phase = 0.2f * static_cast<float>(t) + static_cast<float>(j);
      leader.at(t, j) = {0.2f * std::sin(phase), 0.1f * static_cast<float>(j),
                         0.2f * std::cos(phase)};
    }
  }
  return leader;
}

std::vector<float> Label() {
  std::vector<float> label(Model().description().classes.size(), 0);
  label[0] = 1;
  return label;
}

void Windows(const duet::engine::Synthesizer& model, benchmark::State& state) {
  const int frames = Model().description().window_frames;
  duet::engine::SynthesisWindow window;
  window.leader = Leader(frames);
  for (int t = 0; t < frames; ++t) {
    const std::vector<float> label = Label();
    window.labels.insert(window.labels.end(), label.begin(), label.end());
  }
  const std::vector<const duet::engine::SynthesisWindow*> batch(static_cast<size_t>(state.range(0)),
                                                                &window);
  for (auto _ : state) benchmark::DoNotOptimize(model.Synthesize(batch));
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(state.range(0)) * frames,
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

void BM_Windows(benchmark::State& state) { Windows(Model(), state); }
BENCHMARK(BM_Windows)->Arg(1)->Arg(4)->Arg(16)->Arg(32)->Unit(benchmark::kMillisecond);

void BM_SampledWindows(benchmark::State& state) { Windows(SamplingModel(), state); }
BENCHMARK(BM_SampledWindows)->Arg(1)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);

void BM_TenMinutes(benchmark::State& state) {
  const duet::engine::ClipRequest request{
      Leader(kLongFrames), kLongRateHz, duet::engine::LabelTrack(Label()), {}, {}};
  for (auto _ : state) {
    duet::engine::ClipSynthesis clip(Model().description(), request);
    while (clip.HasNextWindow()) {
      const duet::engine::SynthesisWindow window = clip.NextWindow();
      const duet::engine::SynthesisWindow* const one = &window;
      benchmark::DoNotOptimize(clip.Accept(*Model().Synthesize({&one, 1}).front()));
    }
  }
  state.counters["frames/s"] =
      benchmark::Counter(kLongFrames, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_TenMinutes)->Unit(benchmark::kMillisecond);

}  // namespace
