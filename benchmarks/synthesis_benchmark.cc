// How fast the engine answers: frames a second by batch, and a long clip from end to end.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "model/engine/clip_synthesis.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace {

constexpr int kLongFrames = 18000;  // 10 minutes at 30 frames a second
constexpr double kLongRateHz = 30;

const duet::engine::Synthesizer& Embedded(std::string_view name, int version) {
  static const auto* const kModels = [] {
    duet::torch_engine::SetTorchThreads(1);
    auto loaded = duet::torch_engine::LoadEmbeddedSynthesizers();
    if (!loaded.ok()) {
      std::cerr << loaded.status().message() << "\n";
      std::exit(1);
    }
    return new std::vector<std::unique_ptr<duet::engine::Synthesizer>>(*std::move(loaded));
  }();
  for (const auto& model : *kModels) {
    if (model->description().name == name && model->description().version == version) return *model;
  }
  std::cerr << "no " << name << " version " << version << "\n";
  std::exit(1);
}

// The paper's generator, and the one that samples; the same skeleton and classes.
const duet::engine::Synthesizer& Model() { return Embedded("sbu", 1); }
const duet::engine::Synthesizer& SamplingModel() { return Embedded("sbu", 2); }

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

void TenMinutes(const duet::engine::Synthesizer& model, benchmark::State& state) {
  const duet::engine::ClipRequest request{
      Leader(kLongFrames), kLongRateHz, duet::engine::LabelTrack(Label()), {}, {}};
  for (auto _ : state) {
    duet::engine::ClipSynthesis clip(model.description(), request);
    while (clip.HasNextWindow()) {
      const duet::engine::SynthesisWindow window = clip.NextWindow();
      const duet::engine::SynthesisWindow* const one = &window;
      benchmark::DoNotOptimize(clip.Accept(*model.Synthesize({&one, 1}).front()));
    }
  }
  state.counters["frames/s"] =
      benchmark::Counter(kLongFrames, benchmark::Counter::kIsIterationInvariantRate);
}

void BM_TenMinutes(benchmark::State& state) { TenMinutes(Model(), state); }
BENCHMARK(BM_TenMinutes)->Unit(benchmark::kMillisecond);

void BM_SampledTenMinutes(benchmark::State& state) { TenMinutes(SamplingModel(), state); }
BENCHMARK(BM_SampledTenMinutes)->Unit(benchmark::kMillisecond);

}  // namespace
