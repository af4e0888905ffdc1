// How fast the engines answer: windows by batch, a whole answer by its candidates, and a long clip
// from end to end, side by side.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/embedded/embedded.h"
#include "model/engine/clip_synthesis.h"
#include "model/network/exceptions.h"
#include "model/network/torch_network.h"

namespace {

using duet::cpu_engine::kernels::Precision;
using duet::engine::Synthesizer;
using Models = std::vector<std::unique_ptr<Synthesizer>>;

// From a window to what 46,000 frames cost: time should grow as the clip does.
constexpr int kClipFrames[] = {46, 460, 4600, 46000};
// Of a whole answer.
constexpr int kAnswerFrames = 45;

template <typename T>
T Loaded(absl::StatusOr<T> loaded) {
  if (loaded.ok()) return *std::move(loaded);
  std::cerr << loaded.status().message() << "\n";
  std::exit(1);
}

Models LoadTorchModels() {
  Models models;
  for (const auto& embedded : duet::embedded::EmbeddedCheckpoints()) {
    const auto checkpoint =
        Loaded(duet::checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights));
    models.push_back(MakeSynthesizer(checkpoint.manifest.model, checkpoint.manifest.standardisation,
                                     Loaded(duet::network::MakeTorchNetwork(checkpoint))));
  }
  return models;
}

// A made-up person who sways: speed does not depend on what the leader does.
duet::motion::Poses Leader(int frames, int joints) {
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

std::vector<float> Label(const Synthesizer& model) {
  std::vector<float> label(model.description().classes.size(), 0);
  label[0] = 1;
  return label;
}

void Windows(benchmark::State& state, const Synthesizer* model, bool clean_up) {
  const int frames = model->description().window_frames;
  duet::engine::SynthesisWindow window;
  window.leader = Leader(frames, model->description().skeleton.joint_count());
  window.options.clean_up = clean_up;
  for (int t = 0; t < frames; ++t) {
    const std::vector<float> label = Label(*model);
    window.labels.insert(window.labels.end(), label.begin(), label.end());
  }
  const std::vector<const duet::engine::SynthesisWindow*> batch(static_cast<size_t>(state.range(0)),
                                                                &window);
  for (auto _ : state) benchmark::DoNotOptimize(model->Synthesize(batch));
  state.counters["windows/s"] = benchmark::Counter(static_cast<double>(state.range(0)),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

// A clip at the model's own frame rate.
duet::engine::ClipRequest Request(const Synthesizer& model, int frames) {
  return {Leader(frames, model.description().skeleton.joint_count()),
          model.description().frame_rate_hz,
          duet::engine::LabelTrack(Label(model)),
          {},
          {}};
}

void Answer(const Synthesizer& model, const duet::engine::ClipRequest& request) {
  duet::engine::ClipSynthesis clip(model.description(), request);
  while (clip.HasNextWindow()) {
    const duet::engine::SynthesisWindow window = clip.NextWindow();
    const duet::engine::SynthesisWindow* const one = &window;
    benchmark::DoNotOptimize(clip.Accept(*model.Synthesize({&one, 1}).front()));
  }
}

// As a server answers by default: cleaned up and graded.
void Candidates(benchmark::State& state, const Synthesizer* model) {
  duet::engine::ClipRequest request = Request(*model, kAnswerFrames);
  request.options.clean_up = true;
  request.options.sampling.candidates = static_cast<int>(state.range(0));
  for (auto _ : state) Answer(*model, request);
}

void Clip(benchmark::State& state, const Synthesizer* model) {
  const int frames = static_cast<int>(state.range(0));
  const duet::engine::ClipRequest request = Request(*model, frames);
  for (auto _ : state) Answer(*model, request);
  state.counters["frames/s"] =
      benchmark::Counter(frames, benchmark::Counter::kIsIterationInvariantRate);
}

void Register(const std::string& engine, const Models& models) {
  for (const std::unique_ptr<Synthesizer>& model : models) {
    const std::string name = model->description().name + "@" +
                             std::to_string(model->description().version) + "/" + engine;
    for (const bool clean_up : {false, true}) {
      const std::string what = clean_up ? "cleaned_windows/" : "windows/";
      benchmark::RegisterBenchmark((what + name).c_str(), Windows, model.get(), clean_up)
          ->Arg(1)
          ->Arg(8)
          ->Arg(32)
          ->Arg(64)
          ->Unit(benchmark::kMillisecond);
    }
    if (model->description().samples) {
      benchmark::RegisterBenchmark(("candidates/" + name).c_str(), Candidates, model.get())
          ->Arg(1)
          ->Arg(8)
          ->Unit(benchmark::kMillisecond);
    }
    auto* clip = benchmark::RegisterBenchmark(("clip/" + name).c_str(), Clip, model.get())
                     ->Unit(benchmark::kMillisecond);
    for (const int frames : kClipFrames) clip->Arg(frames);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (const absl::Status status = duet::network::SetThreads(1); !status.ok()) {
    std::cerr << status.message() << "\n";
    return 1;
  }
  const Models torch = LoadTorchModels();
  const Models f32 =
      Loaded(duet::cpu_engine::LoadEmbeddedSynthesizers({true, Precision::kFloat32}));
  const Models int16 =
      Loaded(duet::cpu_engine::LoadEmbeddedSynthesizers({true, Precision::kInt16}));
  Register("torch", torch);
  Register("f32", f32);
  Register("int16", int16);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
