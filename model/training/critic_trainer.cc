#include "model/training/critic_trainer.h"

#include <torch/torch.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "model/base/random.h"
#include "model/checkpoint/critic_tensors.h"
#include "model/engine/critic.h"
#include "model/engine/finished_motions.h"
#include "model/motion/filter.h"
#include "model/training/frame_labels.h"
#include "model/training/optimiser.h"
#include "model/training/sampler.h"
#include "model/training/trained_synthesizer.h"

namespace duet::training {
namespace {

namespace F = torch::nn::functional;

constexpr int64_t kHalfBatch = 16;  // examples of each kind in a step
constexpr double kDropout = 0.3;
// The critic must not depend on a person's proportions or on a clip's ends: a constant error of
// each input, in deviations, and the least share of a clip that is seen.
constexpr double kInputError = 0.15, kLeastShare = 0.7;
constexpr int64_t kLeastFrames = 4;
constexpr double kSmoothedTarget = 0.9;  // the probability that a captured follower should get
constexpr double kLeastDeviation = 0.02;

TrainingOptions::Optimiser OptimiserSettings() {
  TrainingOptions::Optimiser settings;
  settings.learning_rate = 3e-3;
  settings.schedule = "cosine";
  settings.warm_up_steps = 0;
  settings.last_share = 0;
  settings.weight_decay = 1e-2;
  settings.gradient_clip = 1;
  return settings;
}

// Windows of the training sequences, and their captured followers.
struct Windows {
  std::vector<engine::SynthesisWindow> windows;
  std::vector<motion::Poses> captured;
};

Windows MakeWindows(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                    StartKnowledge start, double smoothing, base::Random* random) {
  Windows made;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    engine::SynthesisWindow window = MakeWindow(dataset, CapturedExample(dataset, sequence, start));
    window.labels = DrawFrameLabels(sequence, dataset.class_count(), {}, random);
    window.options.sampling.seed = static_cast<uint64_t>(random->Below(INT64_MAX));
    made.windows.push_back(std::move(window));
    made.captured.push_back(motion::GaussianFilter(sequence.pair.follower.poses, smoothing));
  }
  return made;
}

using Inputs = std::vector<torch::Tensor>;  // [critic frames, I] each

absl::Status AddInputs(const engine::ModelDescription& model, const Windows& made,
                       const std::vector<engine::WindowResult>& followers, Inputs* inputs) {
  const int64_t columns = engine::CriticInputs(model.skeleton, model.class_count());
  for (size_t i = 0; i < followers.size(); ++i) {
    if (!followers[i].ok()) return followers[i].status();
    const std::vector<float> values =
        engine::CriticInput(model.skeleton, model.frame_rate_hz, made.windows[i].leader,
                            *followers[i], made.windows[i].labels);
    inputs->push_back(torch::tensor(values).view({-1, columns}));
  }
  return absl::OkStatus();
}

// What the critic learns from.
struct Material {
  Inputs captured, sampled;
};

absl::StatusOr<Material> Gather(const FlowTraining& flow, const checkpoint::Checkpoint& checkpoint,
                                const dataset::Dataset& dataset, std::vector<int> train,
                                base::Random* random) {
  const engine::ModelDescription& model = checkpoint.manifest.model;
  const absl::StatusOr<std::unique_ptr<engine::Synthesizer>> synthesizer =
      SynthesizerOf(checkpoint);
  if (!synthesizer.ok()) return synthesizer.status();
  // No more than the steps will draw.
  const auto most = static_cast<size_t>(
      std::max<int64_t>(1, flow.critic.steps * kHalfBatch / flow.critic.answers));
  Material material;
  for (int64_t n = 0; n < flow.critic.answers; ++n) {
    random->Shuffle(&train);
    const std::vector<int> some(
        train.begin(), train.begin() + static_cast<std::ptrdiff_t>(std::min(most, train.size())));
    const Windows made =
        MakeWindows(dataset, some, n % 2 == 0 ? StartKnowledge::kNone : StartKnowledge::kPose,
                    flow.target_smoothing, random);
    absl::Status status =
        AddInputs(model, made, AnswerAll(**synthesizer, made.windows), &material.sampled);
    // A captured follower is the same every time, but for the parts that `some` has.
    if (status.ok() && (n < 2 || some.size() < train.size())) {
      status = AddInputs(model, made, FinishMotions(model, made.windows, made.captured),
                         &material.captured);
    }
    if (!status.ok()) return status;
  }
  return material;
}

// Mean and deviation of the inputs; those of labels are left as they are.
struct Scale {
  torch::Tensor mean, deviation;  // [I]
};

Scale ScaleOf(const Inputs& inputs, int64_t classes) {
  const torch::Tensor all = torch::cat(inputs);
  Scale scale{all.mean(0), all.std(0, /*unbiased=*/false) + kLeastDeviation};
  const int64_t columns = all.size(1);
  scale.mean.slice(0, columns - classes).zero_();
  scale.deviation.slice(0, columns - classes).fill_(1);
  return scale;
}

struct CriticModuleImpl : torch::nn::Module {
  explicit CriticModuleImpl(int64_t inputs)
      : frames(register_module("frames", torch::nn::Linear(inputs, engine::kCriticUnits))),
        near(register_module("near", Convolution(1))),
        far(register_module("far", Convolution(engine::kCriticDilation))),
        output(register_module("output", torch::nn::Linear(engine::kCriticUnits, 1))) {}

  static torch::nn::Conv1d Convolution(int64_t dilation) {
    constexpr int64_t kUnits = engine::kCriticUnits, kKernel = engine::kCriticKernel;
    return torch::nn::Conv1d(torch::nn::Conv1dOptions(kUnits, kUnits, kKernel)
                                 .padding(kKernel / 2 * dilation)
                                 .dilation(dilation));
  }

  // Shapes: input [N, T, I]; mask [N, T] 1 in the frames of each example; returns [N].
  torch::Tensor forward(const torch::Tensor& input, const torch::Tensor& mask) {
    const auto dropout = [](const torch::Tensor& x) {
      return F::dropout(x, F::DropoutFuncOptions().p(kDropout));
    };
    const torch::Tensor columns = mask.unsqueeze(1);
    torch::Tensor x = torch::relu(frames(dropout(input))).transpose(1, 2) * columns;
    x = x + torch::relu(near(x)) * columns;
    x = x + torch::relu(far(x)) * columns;
    return (output(dropout(x.transpose(1, 2))).squeeze(2) * mask).sum(1) / mask.sum(1);
  }

  torch::nn::Linear frames;
  torch::nn::Conv1d near, far;
  torch::nn::Linear output;
};
TORCH_MODULE(CriticModule);

// A part of an example, with a constant error.
torch::Tensor Vary(const torch::Tensor& example, base::Random* random) {
  const int64_t frames = example.size(0);
  const auto share =
      static_cast<int64_t>(static_cast<double>(frames) * random->Uniform(kLeastShare, 1));
  const int64_t length = std::min(frames, std::max(kLeastFrames, share));
  const int64_t first = random->Below(frames - length + 1);
  return example.slice(0, first, first + length) + torch::randn({example.size(1)}) * kInputError;
}

struct CriticBatch {
  torch::Tensor input, mask, target;  // [N, T, I], [N, T], [N]
};

CriticBatch DrawBatch(const Material& material, const Scale& scale, base::Random* random) {
  Inputs inputs, masks;
  for (int64_t i = 0; i < 2 * kHalfBatch; ++i) {
    const Inputs& kind = i < kHalfBatch ? material.captured : material.sampled;
    const torch::Tensor& example =
        kind[static_cast<size_t>(random->Below(static_cast<int64_t>(kind.size())))];
    inputs.push_back(Vary((example - scale.mean) / scale.deviation, random));
    masks.push_back(torch::ones(inputs.back().size(0)));
  }
  const torch::Tensor captured = torch::full({kHalfBatch}, kSmoothedTarget);
  return {torch::nn::utils::rnn::pad_sequence(inputs, /*batch_first=*/true),
          torch::nn::utils::rnn::pad_sequence(masks, /*batch_first=*/true),
          torch::cat({captured, 1 - captured})};
}

// The tensors of the critic, with the scale of its inputs in the first layer.
std::vector<checkpoint::Tensor> Store(const engine::ModelDescription& model, CriticModule& critic,
                                      const Scale& scale) {
  const torch::NoGradGuard no_grad;
  const torch::Tensor weight = critic->frames->weight / scale.deviation;
  const Inputs values = {weight,
                         critic->frames->bias - weight.mv(scale.mean),
                         critic->near->weight,
                         critic->near->bias,
                         critic->far->weight,
                         critic->far->bias,
                         critic->output->weight,
                         critic->output->bias};
  std::vector<checkpoint::Tensor> tensors;
  for (const checkpoint::TensorSpec& spec : checkpoint::CriticTensors(model)) {
    const torch::Tensor value = values[tensors.size()].contiguous();
    const float* data = value.data_ptr<float>();
    tensors.push_back({spec.name, spec.shape, std::vector<float>(data, data + value.numel())});
  }
  return tensors;
}

}  // namespace

absl::StatusOr<TrainedCritic> TrainCritic(const FlowTraining& flow, uint64_t seed,
                                          const checkpoint::Checkpoint& generator,
                                          const dataset::Dataset& dataset,
                                          const std::vector<int>& train) {
  base::Random random(seed);
  const absl::StatusOr<Material> material = Gather(flow, generator, dataset, train, &random);
  if (!material.ok()) return material.status();
  const Scale scale = ScaleOf(material->captured, dataset.class_count());
  torch::manual_seed(seed);
  CriticModule critic(scale.mean.size(0));
  Optimiser optimiser(OptimiserSettings(), critic->parameters(), flow.critic.steps);
  TrainedCritic trained;
  const int64_t last = std::max<int64_t>(1, flow.critic.steps / 10);
  for (int64_t step = 0; step < flow.critic.steps; ++step) {
    const CriticBatch batch = DrawBatch(*material, scale, &random);
    const torch::Tensor loss =
        F::binary_cross_entropy_with_logits(critic(batch.input, batch.mask), batch.target);
    loss.backward();
    optimiser.Step(step);
    if (step >= flow.critic.steps - last) {
      trained.loss += loss.item<double>() / static_cast<double>(last);
    }
  }
  trained.tensors = Store(generator.manifest.model, critic, scale);
  return trained;
}

}  // namespace duet::training
