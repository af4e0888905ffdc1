#include "model/evaluation/judge/judge.h"

#include <torch/torch.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/network/batch.h"
#include "model/network/discriminator.h"
#include "model/network/generator.h"
#include "model/network/parameters.h"
#include "model/network/recurrent.h"
#include "model/training/augment.h"
#include "model/training/optimiser.h"
#include "model/training/sampler.h"

namespace duet::evaluation::judge {
namespace {

// Motions per batch outside training: bounds memory and the padding of short motions.
constexpr size_t kTestBatch = 64;

using motion::StandardOrigin;

// Shapes: returns [frames, joints, 3].
torch::Tensor ToTensor(const motion::Poses& poses) {
  const int64_t frames = poses.frame_count();
  return network::PadPoses({&poses}, frames)[0].view({frames, -1, 3});
}

torch::Tensor AboutRoot(const torch::Tensor& poses, int root) {
  return poses - poses.narrow(1, root, 1);
}

// Central differences, one-sided at the ends, times the rate.
torch::Tensor Velocity(const torch::Tensor& poses, double rate) {
  const torch::Tensor frame = torch::arange(poses.size(0));
  const torch::Tensor before = (frame - 1).clamp_min(0);
  const torch::Tensor after = (frame + 1).clamp_max(poses.size(0) - 1);
  const torch::Tensor frames = (after - before).clamp_min(1).to(poses.dtype());
  return (poses.index_select(0, after) - poses.index_select(0, before)) *
         (rate / frames).view({-1, 1, 1});
}

// What the classifier sees of a pair: vectors of every joint, three from Sees::kFollower, five from
// Sees::kBoth. Shapes: returns [frames, 3 x vectors x joints], all joints of the first vector
// first.
torch::Tensor ClassifierInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                              Sees sees) {
  const motion::ClipPair& pair = sequence.pair;
  const double rate = pair.follower.frame_rate_hz;
  const auto every_frame = metrics::StandardOf(skeleton, sequence, StandardOrigin::kEveryFrame);
  const auto first_frame = metrics::StandardOf(skeleton, sequence, StandardOrigin::kFirstFrame);
  const torch::Tensor from_leader = ToTensor(every_frame.Apply(pair.follower.poses));
  const torch::Tensor follows = ToTensor(first_frame.Apply(pair.follower.poses));
  std::vector<torch::Tensor> input = {from_leader, AboutRoot(from_leader, skeleton.root),
                                      Velocity(follows, rate)};
  if (sees == Sees::kBoth) {
    const torch::Tensor leads = ToTensor(first_frame.Apply(pair.leader.poses));
    input.insert(input.end(), {AboutRoot(leads, skeleton.root), Velocity(leads, rate)});
  }
  return torch::cat(input, 1).flatten(1);
}

struct MotionBatch {
  torch::Tensor motion;   // [N, T, input], padded with zeros
  torch::Tensor lengths;  // [N] int64
  torch::Tensor classes;  // [N] int64
};

// The sequences of motions with these followers.
std::vector<dataset::Sequence> WithFollowers(const dataset::Dataset& dataset,
                                             const std::vector<metrics::ScoredMotion>& motions) {
  std::vector<dataset::Sequence> sequences;
  for (const metrics::ScoredMotion& motion : motions) {
    sequences.push_back(SequenceOf(dataset, motion));
    sequences.back().pair.follower.poses = motion.follower;
  }
  return sequences;
}

MotionBatch MakeMotionBatch(const dataset::Dataset& dataset,
                            const std::vector<dataset::Sequence>& sequences, Sees sees) {
  std::vector<torch::Tensor> inputs;
  std::vector<int64_t> lengths, classes;
  for (const dataset::Sequence& sequence : sequences) {
    inputs.push_back(ClassifierInput(dataset.skeleton, sequence, sees));
    lengths.push_back(sequence.pair.follower.frame_count());
    classes.push_back(sequence.interaction_class);
  }
  return {torch::nn::utils::rnn::pad_sequence(inputs, /*batch_first=*/true), torch::tensor(lengths),
          torch::tensor(classes)};
}

// `size` sequences in each batch but the last, in order.
std::vector<MotionBatch> Batches(const dataset::Dataset& dataset,
                                 const std::vector<dataset::Sequence>& sequences, size_t size,
                                 Sees sees) {
  std::vector<MotionBatch> batches;
  for (size_t first = 0; first < sequences.size(); first += size) {
    const auto begin = sequences.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(size, sequences.size() - first));
    batches.push_back(MakeMotionBatch(dataset, {begin, end}, sees));
  }
  return batches;
}

// To generalise to unseen people, the classifier must not depend on the proportions of the people
// in the clip, nor on the clip's start and end: both are varied. These values, like the defaults of
// MotionClassifierOptions, were chosen on held-back training subjects.
constexpr int64_t kTrainingBatch = 16;
constexpr double kLearningRate = 2e-3, kWeightDecay = 0.01, kDropout = 0.3, kLabelSmoothing = 0.1;

training::CommonSettings::Augmentation Variations() {
  training::CommonSettings::Augmentation augmentation;
  augmentation.set_body_scale(0.1);
  augmentation.set_crop(0.3);
  return augmentation;
}

dataset::Sequence Vary(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
                       double body_noise, base::Random* random) {
  dataset::Sequence varied = Augment(dataset, sequence, Variations(), random);
  const auto draw = [&] { return static_cast<float>(random->Normal(body_noise)); };
  std::vector<motion::Vec3> offsets;
  for (int j = 0; j < dataset.skeleton.joint_count(); ++j) {
    offsets.push_back(motion::Vec3{draw(), draw(), draw()});
  }
  motion::Poses& poses = varied.pair.follower.poses;
  for (int t = 0; t < poses.frame_count(); ++t) {
    for (size_t j = 0; j < offsets.size(); ++j) poses[t][j] += offsets[j];
  }
  return varied;
}

// The batches of one epoch: every motion once, varied, in a new random order.
std::vector<MotionBatch> EpochBatches(const dataset::Dataset& dataset,
                                      const std::vector<dataset::Sequence>& sequences,
                                      const MotionClassifierOptions& options, int64_t epoch) {
  base::Random random(options.seed, epoch);
  std::vector<dataset::Sequence> varied;
  for (const dataset::Sequence& sequence : sequences) {
    varied.push_back(Vary(dataset, sequence, options.body_noise, &random));
  }
  random.Shuffle(&varied);
  return Batches(dataset, varied, size_t{kTrainingBatch}, options.sees);
}

network::Discriminator TrainNetwork(const dataset::Dataset& dataset,
                                    const std::vector<dataset::Sequence>& sequences,
                                    const MotionClassifierOptions& options) {
  network::DiscriminatorOptions sizes;
  sizes.input = ClassifierInput(dataset.skeleton, sequences.front(), options.sees).size(1);
  sizes.window_frames = dataset.LongestFrameCount();
  sizes.hidden = options.hidden;
  sizes.outputs = dataset.class_count();
  torch::manual_seed(options.seed);
  network::Discriminator network(sizes);
  network->set_dropout(kDropout);
  const int64_t count = static_cast<int64_t>(sequences.size());
  const int64_t steps = options.epochs * ((count + kTrainingBatch - 1) / kTrainingBatch);
  training::CommonSettings::Optimiser settings;
  settings.set_learning_rate(kLearningRate);
  settings.set_weight_decay(kWeightDecay);
  settings.set_gradient_clip(1);
  training::Optimiser optimiser(settings, network->parameters(), steps);
  const auto smoothed =
      torch::nn::functional::CrossEntropyFuncOptions().label_smoothing(kLabelSmoothing);
  int64_t step = 0;
  for (int64_t epoch = 0; epoch < options.epochs; ++epoch) {
    for (const MotionBatch& batch : EpochBatches(dataset, sequences, options, epoch)) {
      const torch::Tensor logits = network->forward(batch.motion, batch.lengths);
      torch::nn::functional::cross_entropy(logits, batch.classes, smoothed).backward();
      optimiser.Step(step++);
    }
  }
  network->eval();
  return network;
}

absl::Status CheckMotions(const dataset::Dataset& dataset,
                          const std::vector<metrics::ScoredMotion>& motions) {
  std::vector<int> counts(dataset.classes.size());
  for (const metrics::ScoredMotion& motion : motions) {
    ++counts[static_cast<size_t>(SequenceOf(dataset, motion).interaction_class)];
  }
  for (size_t c = 0; c < counts.size(); ++c) {
    if (counts[c] > 0) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("motions: expected at least one of class ", dataset.classes[c], ", got none"));
  }
  return absl::OkStatus();
}

}  // namespace

struct MotionClassifier::Model {
  std::vector<network::Discriminator> members;
  Sees sees = Sees::kFollower;
};

absl::StatusOr<MotionClassifier> MotionClassifier::Train(
    const dataset::Dataset& dataset, const std::vector<metrics::ScoredMotion>& motions,
    const MotionClassifierOptions& options) {
  DUET_RETURN_IF_ERROR(CheckMotions(dataset, motions));
  const std::vector<dataset::Sequence> sequences = WithFollowers(dataset, motions);
  auto model = std::make_shared<Model>();
  model->sees = options.sees;
  for (int64_t m = 0; m < options.members; ++m) {
    MotionClassifierOptions member = options;
    member.seed = options.seed * static_cast<uint64_t>(options.members) + static_cast<uint64_t>(m);
    model->members.push_back(TrainNetwork(dataset, sequences, member));
  }
  return MotionClassifier(std::move(model));
}

metrics::JudgedFold MotionClassifier::Judge(
    const dataset::Dataset& dataset, const std::vector<metrics::ScoredMotion>& motions) const {
  torch::NoGradGuard no_grad;
  metrics::JudgedFold judged;
  const std::vector<dataset::Sequence> sequences = WithFollowers(dataset, motions);
  for (const dataset::Sequence& sequence : sequences) {
    judged.classes.push_back(sequence.interaction_class);
  }
  for (const MotionBatch& batch : Batches(dataset, sequences, kTestBatch, model_->sees)) {
    std::vector<torch::Tensor> probabilities, features;
    for (network::Discriminator& network : model_->members) {
      probabilities.push_back(network->forward(batch.motion, batch.lengths).softmax(1));
      features.push_back(network->Features(batch.motion, batch.lengths));
    }
    network::AppendRows(torch::stack(probabilities).mean(0), &judged.probabilities);
    network::AppendRows(torch::cat(features, 1), &judged.features);
  }
  return judged;
}

absl::StatusOr<metrics::FeatureSet> LatentFeatures(const checkpoint::Checkpoint& checkpoint,
                                                   const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences,
                                                   bool labelled) {
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
  for (size_t first = 0; first < sequences.size(); first += kTestBatch) {
    std::vector<training::Example> examples;
    for (size_t i = first; i < std::min(sequences.size(), first + kTestBatch); ++i) {
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
