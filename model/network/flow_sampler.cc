#include "model/network/flow_sampler.h"

#include <cmath>

#include "model/base/angle.h"
#include "model/network/flow_noise.h"

namespace duet::network {
namespace {

using base::kPi;

// The terms collected so far.
struct Terms {
  std::vector<int64_t> windows;
  std::vector<torch::Tensor> labels, factors;

  void AddUnlessZero(int64_t window, const torch::Tensor& label, const torch::Tensor& factor) {
    if (!factor.any().item<bool>()) return;
    windows.push_back(window);
    labels.push_back(label);
    factors.push_back(factor.unsqueeze(1));
  }
};

// The guided answer to every window: [N, T, 3 J].
torch::Tensor Guided(const FlowGenerator& generator, const FlowContext& rows,
                     const GuidanceTerms& terms, const torch::Tensor& sample, double time) {
  const torch::Tensor times = torch::full({terms.windows.size(0)}, time, sample.options());
  const torch::Tensor answers =
      generator->forward(rows, terms.labels, sample.index_select(0, terms.windows), times);
  return torch::zeros_like(sample).index_add_(0, terms.windows, terms.factors * answers);
}

torch::Tensor WithKnown(const torch::Tensor& answer, const FlowInput& input) {
  return answer * (1 - input.is_known) + input.known;
}

// Takes Euler steps from noise to motion; returns the last result of `answer(sample, time)`.
template <typename Answer>
torch::Tensor TakeSteps(int steps, const FlowInput& input, const torch::Tensor& source,
                        const Answer& answer) {
  torch::Tensor sample = source, last;
  for (int step = 0; step < steps; ++step) {
    last = answer(sample, static_cast<double>(step) / steps);
    sample = sample + (WithKnown(last, input) - sample) / static_cast<double>(steps - step);
  }
  return last;
}

// [N, T, 1] 1 in the last known frame, falling to 0 along half a cosine; 0 without known frames.
torch::Tensor Fade(const FlowInput& input, int fade_frames) {
  const torch::Tensor frame =
      torch::arange(input.leader.size(1), input.known_count.options()).unsqueeze(0);
  const torch::Tensor since =
      (frame - input.known_count.unsqueeze(1) + 1).clamp(0, fade_frames + 1);
  const torch::Tensor fade =
      0.5 + 0.5 * torch::cos(since.to(torch::kFloat32) * (kPi / (fade_frames + 1)));
  return (fade * (input.known_count > 0).unsqueeze(1)).unsqueeze(2);
}

// Shifts the frames after the known ones to continue from the last known frame, at offset 0.
torch::Tensor Joined(const torch::Tensor& answer, const FlowInput& input, int fade_frames) {
  const int64_t count = answer.size(0), width = answer.size(2);
  const torch::Tensor last =
      (input.known_count - 1).clamp_min(0).view({count, 1, 1}).expand({count, 1, width});
  return WithKnown(answer - Fade(input, fade_frames) * answer.gather(1, last), input);
}

torch::Tensor Varieties(absl::Span<const engine::NetworkInput> inputs) {
  std::vector<float> varieties;
  for (const engine::NetworkInput& input : inputs) varieties.push_back(input.sampling.variety);
  return torch::tensor(varieties).view({-1, 1, 1});
}

// Every window once, with its labels in the frames.
GuidanceTerms OneTermEach(const FlowInput& input) {
  const int64_t count = input.labels.size(0), frames = input.labels.size(1);
  const torch::TensorOptions like = input.labels.options();
  return {torch::arange(count, input.lengths.options()),
          torch::zeros({count, input.labels.size(2)}, like), torch::ones({count, frames, 1}, like)};
}

}  // namespace

GuidanceTerms MakeGuidanceTerms(const torch::Tensor& window_labels,
                                const torch::Tensor& window_lengths, double guidance) {
  const torch::Tensor labels = window_labels.cpu(), lengths = window_lengths.cpu();
  const int64_t count = labels.size(0), frames = labels.size(1), classes = labels.size(2);
  const torch::Tensor one_class = torch::eye(classes), no_class = torch::zeros({classes});
  Terms terms;
  for (int64_t n = 0; n < count; ++n) {
    const int64_t length = lengths[n].item<int64_t>();
    const torch::Tensor raw = labels[n].narrow(0, 0, length);
    const torch::Tensor weights = torch::where(raw > 0, guidance * raw, raw);
    const auto padded = [&](const torch::Tensor& factor) {
      return torch::constant_pad_nd(factor, {0, frames - length});
    };
    terms.AddUnlessZero(n, no_class, padded(1 - weights.sum(1)));
    for (int64_t k = 0; k < classes; ++k) {
      terms.AddUnlessZero(n, one_class[k], padded(weights.select(1, k)));
    }
  }
  const torch::Device device = window_labels.device();
  return {torch::tensor(terms.windows).to(device), torch::stack(terms.labels).to(device),
          torch::stack(terms.factors).to(device)};
}

torch::Tensor PlainAnswers(const FlowGenerator& generator,
                           const checkpoint::FlowArchitecture& architecture, const FlowInput& input,
                           const torch::Tensor& labels, const torch::Tensor& source) {
  const torch::Tensor rows =
      torch::arange(source.size(1), input.lengths.options()).repeat({source.size(0)});
  const FlowContext context = Rows(generator->Prepare(input), rows);
  const torch::Tensor row_labels = labels.index_select(0, rows);
  FlowInput row_input = input;
  row_input.known = input.known.index_select(0, rows);
  row_input.is_known = input.is_known.index_select(0, rows);
  const torch::Tensor answers =
      TakeSteps(architecture.steps, row_input, source.flatten(0, 1),
                [&](const torch::Tensor& sample, double time) {
                  return generator->forward(context, row_labels, sample,
                                            torch::full({sample.size(0)}, time, sample.options()));
                });
  return answers.view_as(source);
}

torch::Tensor SampleFlow(const FlowGenerator& generator,
                         const checkpoint::FlowArchitecture& architecture, const FlowInput& input,
                         const torch::Tensor& source) {
  const GuidanceTerms terms =
      architecture.frame_labels
          ? OneTermEach(input)
          : MakeGuidanceTerms(input.labels, input.lengths, architecture.guidance);
  const FlowContext rows = Rows(generator->Prepare(input), terms.windows);
  const torch::Tensor answer =
      TakeSteps(architecture.steps, input, source, [&](const torch::Tensor& sample, double time) {
        return Guided(generator, rows, terms, sample, time);
      });
  // The last step ends exactly at the answer.
  return Joined(answer, input, architecture.fade_frames) * architecture.offset_scale +
         input.base.unsqueeze(1);
}

torch::Tensor AnswerWindows(const FlowGenerator& generator, const checkpoint::Manifest& manifest,
                            absl::Span<const engine::NetworkInput> inputs) {
  const torch::Device device = generator->device();
  const FlowInput input = MakeFlowInput(manifest, generator->base_poses().cpu(), inputs).To(device);
  const auto& architecture = std::get<checkpoint::FlowArchitecture>(manifest.architecture);
  const torch::Tensor source =
      SourceNoise(architecture.noise, generator->noise_roots(), input.known_count,
                  DrawNoise(inputs, architecture.noise.frame_length).To(device));
  return SampleFlow(generator, architecture, input, Varieties(inputs).to(device) * source).cpu();
}

}  // namespace duet::network
