#include "model/training/finishing.h"

#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "model/base/random.h"
#include "model/base/status_macros.h"
#include "model/checkpoint/architecture.h"
#include "model/engine/capture_fits.h"
#include "model/engine/critic.h"
#include "model/engine/network_synthesizer.h"
#include "model/motion/filter.h"
#include "model/motion/poses.h"
#include "model/network/torch_network.h"
#include "model/training/optimiser.h"
#include "model/training/sampler.h"

namespace duet::training {
namespace {

constexpr std::size_t kWindowsTogether = 64;

// The captured pairs of some sequences; of one class: only its stretches.
engine::Stretches StretchesOf(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                              std::optional<int> interaction_class = std::nullopt) {
  engine::Stretches stretches;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(index)];
    const motion::ClipPair& pair = sequence.pair;
    std::vector<dataset::LabelSpan> spans = sequence.labels;
    if (spans.empty() || !interaction_class) {
      spans = {{sequence.interaction_class, 0, pair.leader.frame_count()}};
    }
    for (const dataset::LabelSpan& span : spans) {
      if (interaction_class.value_or(span.interaction_class) != span.interaction_class) continue;
      stretches.push_back({&pair.leader.poses, &pair.follower.poses, span.begin, span.end});
    }
  }
  return stretches;
}

}  // namespace

void MeasurePairs(const dataset::Dataset& whole, const std::vector<int>& takes,
                  const dataset::Dataset& dataset, const std::vector<int>& train,
                  engine::ModelDescription* model) {
  const motion::Skeleton& skeleton = dataset.skeleton;
  const double rate = dataset.frame_rate_hz;
  for (int c = 0; c < dataset.class_count(); ++c) {
    const std::string& name = dataset.classes[static_cast<std::size_t>(c)];
    const engine::Stretches windows = StretchesOf(dataset, train, c);
    if (const auto metres = engine::HandContactMetres(skeleton, windows, rate)) {
      model->hand_contacts.push_back({name, *metres});
    }
    for (engine::TrunkContact& contact : engine::TrunkContacts(skeleton, windows, rate)) {
      contact.interaction_class = name;
      model->trunk_contacts.push_back(std::move(contact));
    }
    if (const auto degrees = engine::FacingDegrees(skeleton, StretchesOf(whole, takes, c), rate)) {
      model->facing_classes.push_back({name, std::round(*degrees)});
    }
  }
  model->bone_ratios = engine::BoneRatios(skeleton, StretchesOf(whole, takes));
}

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> SynthesizerOf(
    const checkpoint::Checkpoint& checkpoint) {
  DUET_TRY(auto network, network::MakeTorchNetwork(checkpoint));
  return MakeSynthesizer(checkpoint.manifest.model, checkpoint.manifest.standardisation,
                         std::move(network));
}

std::vector<engine::WindowResult> AnswerAll(const engine::Synthesizer& synthesizer,
                                            const std::vector<engine::SynthesisWindow>& windows) {
  std::vector<engine::WindowResult> answers;
  for (std::size_t first = 0; first < windows.size(); first += kWindowsTogether) {
    std::vector<const engine::SynthesisWindow*> some;
    for (std::size_t i = first; i < std::min(first + kWindowsTogether, windows.size()); ++i) {
      some.push_back(&windows[i]);
    }
    for (engine::WindowResult& answer : synthesizer.Synthesize(some)) {
      answers.push_back(std::move(answer));
    }
  }
  return answers;
}

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

CommonSettings::Optimiser OptimiserSettings() {
  CommonSettings::Optimiser settings;
  settings.set_learning_rate(3e-3);
  settings.set_schedule(COSINE);
  settings.set_warm_up_steps(0);
  settings.set_last_share(0);
  settings.set_weight_decay(1e-2);
  settings.set_gradient_clip(1);
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

absl::StatusOr<Material> Gather(const FlowSettings& flow, const checkpoint::Checkpoint& checkpoint,
                                const dataset::Dataset& dataset, std::vector<int> train,
                                base::Random* random) {
  const engine::ModelDescription& model = checkpoint.manifest.model;
  DUET_TRY(const auto synthesizer, SynthesizerOf(checkpoint));
  // No more than the steps will draw.
  const auto most = static_cast<size_t>(
      std::max<int64_t>(1, flow.critic().steps() * kHalfBatch / flow.critic().answers()));
  Material material;
  for (int64_t n = 0; n < flow.critic().answers(); ++n) {
    random->Shuffle(&train);
    const std::vector<int> some(
        train.begin(), train.begin() + static_cast<std::ptrdiff_t>(std::min(most, train.size())));
    const Windows made =
        MakeWindows(dataset, some, n % 2 == 0 ? StartKnowledge::kNone : StartKnowledge::kPose,
                    flow.flow().target_smoothing(), random);
    absl::Status status =
        AddInputs(model, made, AnswerAll(*synthesizer, made.windows), &material.sampled);
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

absl::StatusOr<TrainedCritic> TrainCritic(const FlowSettings& flow, uint64_t seed,
                                          const checkpoint::Checkpoint& generator,
                                          const dataset::Dataset& dataset,
                                          const std::vector<int>& train) {
  base::Random random(seed);
  DUET_TRY(const Material material, Gather(flow, generator, dataset, train, &random));
  const Scale scale = ScaleOf(material.captured, dataset.class_count());
  torch::manual_seed(seed);
  CriticModule critic(scale.mean.size(0));
  Optimiser optimiser(OptimiserSettings(), critic->parameters(), flow.critic().steps());
  TrainedCritic trained;
  const int64_t last = std::max<int64_t>(1, flow.critic().steps() / 10);
  for (int64_t step = 0; step < flow.critic().steps(); ++step) {
    const CriticBatch batch = DrawBatch(material, scale, &random);
    const torch::Tensor loss =
        F::binary_cross_entropy_with_logits(critic(batch.input, batch.mask), batch.target);
    loss.backward();
    optimiser.Step(step);
    if (step >= flow.critic().steps() - last) {
      trained.loss += loss.item<double>() / static_cast<double>(last);
    }
  }
  trained.tensors = Store(generator.manifest.model, critic, scale);
  return trained;
}

namespace {

using motion::Poses;

// Seeds that are tried, and how many of them are kept: enough that callers see different people,
// and few enough that all are good. The cost is kTried answers to kPairsOfClass leaders of each
// class: some ten seconds for the data of the embedded models.
constexpr uint64_t kTried = 128;
constexpr std::size_t kChosen = 16;
constexpr int kPairsOfClass = 8;
// Shorter distances count as this one: followers who stand still have no logarithm. Metres.
constexpr double kLeastMetres = 0.01;

// How far a follower gets: the largest distance of a joint from where it was in the first frame,
// mean over the joints.
double ReachOf(const Poses& follower) {
  double sum = 0;
  for (int j = 0; j < follower.joint_count(); ++j) {
    float most = 0;
    for (int t = 1; t < follower.frame_count(); ++t) {
      most = std::max(most, Distance(follower.at(t, j), follower.at(0, j)));
    }
    sum += double{most};
  }
  return sum / follower.joint_count();
}

// What followers of one class do, sums over its pairs: how far they get, and how near their leaders
// they come, metres.
struct Behaviour {
  double reach = 0, nearest = 0;

  void Add(int root, const Poses& leader, const Poses& follower) {
    reach += ReachOf(follower);
    float least = Distance(leader.at(0, root), follower.at(0, root));
    for (int t = 1; t < follower.frame_count(); ++t) {
      least = std::min(least, Distance(leader.at(t, root), follower.at(t, root)));
    }
    nearest += double{least};
  }
};

// Captured pairs of one class: the leaders' windows, and what the followers do.
struct ClassPairs {
  std::vector<engine::SynthesisWindow> windows;
  Behaviour captured;
};

double SquaredLogRatio(double a, double b) {
  const double times = std::log(std::max(kLeastMetres, a) / std::max(kLeastMetres, b));
  return times * times;
}

std::vector<ClassPairs> DrawPairs(const dataset::Dataset& dataset, std::vector<int> train) {
  base::Random random(0);
  random.Shuffle(&train);
  std::vector<ClassPairs> classes(static_cast<std::size_t>(dataset.class_count()));
  for (const int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<std::size_t>(index)];
    ClassPairs& pairs = classes[static_cast<std::size_t>(sequence.interaction_class)];
    if (pairs.windows.size() == kPairsOfClass) continue;
    engine::SynthesisWindow window =
        MakeWindow(dataset, CapturedExample(dataset, sequence, StartKnowledge::kNone));
    window.labels = DrawFrameLabels(sequence, dataset.class_count(), {}, &random);
    pairs.windows.push_back(std::move(window));
    pairs.captured.Add(dataset.skeleton.root, sequence.pair.leader.poses,
                       sequence.pair.follower.poses);
  }
  return classes;
}

// How unlike captured followers those of a seed are: the squared logarithms of how much farther
// they get, and of how much farther they stay away, sum over the classes.
absl::StatusOr<double> Unlikeness(const engine::Synthesizer& synthesizer, int root,
                                  std::vector<ClassPairs>* classes, uint64_t seed) {
  double unlikeness = 0;
  for (ClassPairs& pairs : *classes) {
    for (engine::SynthesisWindow& window : pairs.windows) window.options.sampling.seed = seed;
    Behaviour answers;
    const std::vector<engine::WindowResult> followers = AnswerAll(synthesizer, pairs.windows);
    for (std::size_t i = 0; i < followers.size(); ++i) {
      if (!followers[i].ok()) return followers[i].status();
      answers.Add(root, pairs.windows[i].leader, *followers[i]);
    }
    unlikeness += SquaredLogRatio(answers.reach, pairs.captured.reach) +
                  SquaredLogRatio(answers.nearest, pairs.captured.nearest);
  }
  return unlikeness;
}

}  // namespace

absl::StatusOr<std::vector<uint64_t>> ChooseDefaultSeeds(const engine::Synthesizer& synthesizer,
                                                         const dataset::Dataset& dataset,
                                                         const std::vector<int>& train) {
  std::vector<ClassPairs> classes = DrawPairs(dataset, train);
  std::vector<double> unlikeness;
  for (uint64_t seed = 0; seed < kTried; ++seed) {
    DUET_TRY(unlikeness.emplace_back(),
             Unlikeness(synthesizer, dataset.skeleton.root, &classes, seed));
  }
  std::vector<uint64_t> seeds(kTried);
  std::iota(seeds.begin(), seeds.end(), uint64_t{0});
  std::stable_sort(seeds.begin(), seeds.end(), [&](uint64_t a, uint64_t b) {
    return unlikeness[static_cast<std::size_t>(a)] < unlikeness[static_cast<std::size_t>(b)];
  });
  seeds.resize(kChosen);
  return seeds;
}

}  // namespace duet::training
