#include "model/evaluation/judge/classifier.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/checkpoint/sha256.h"
#include "model/engine/window_frame.h"
#include "model/network/batch.h"
#include "model/network/discriminator.h"
#include "model/training/augment.h"
#include "model/training/optimiser.h"

namespace duet {

struct MotionClassifier::Model {
  network::Discriminator network{nullptr};
  std::string hash;
};

namespace {

using network::Discriminator;

// Motions at a time when nothing is learned: bounds memory, and long pads short.
constexpr size_t kTestBatch = 64;

struct MotionBatch {
  torch::Tensor motion;   // [N, T, 3 J]
  torch::Tensor lengths;  // [N] int64
  torch::Tensor classes;  // [N] int64
};

// The sequence with its captured follower replaced.
Sequence WithFollower(const Dataset& dataset, const ScoredMotion& motion) {
  Sequence sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
  sequence.pair.follower.positions = motion.follower;
  return sequence;
}

// The follower where its leader expects it: nothing of the follower's own decides the frame.
std::vector<Vec3> StandardFollower(const Dataset& dataset, const Sequence& sequence) {
  SynthesisWindow window;
  window.leader = sequence.pair.leader.positions;
  window.partner_direction = sequence.partner_direction;
  return WindowFrame(dataset.skeleton, window).Apply(sequence.pair.follower.positions);
}

MotionBatch MakeMotionBatch(const Dataset& dataset, const std::vector<Sequence>& sequences) {
  const int joints = dataset.skeleton.joint_count();
  std::vector<std::vector<Vec3>> followers;
  std::vector<int64_t> lengths, classes;
  for (const Sequence& sequence : sequences) {
    followers.push_back(StandardFollower(dataset, sequence));
    lengths.push_back(sequence.pair.follower.frame_count());
    classes.push_back(sequence.interaction_class);
  }
  std::vector<const std::vector<Vec3>*> pointers;
  for (const std::vector<Vec3>& follower : followers) pointers.push_back(&follower);
  return {
      network::PadPositions(pointers, joints, *std::max_element(lengths.begin(), lengths.end())),
      torch::tensor(lengths), torch::tensor(classes)};
}

std::vector<MotionBatch> TestBatches(const Dataset& dataset,
                                     const std::vector<ScoredMotion>& motions) {
  std::vector<MotionBatch> batches;
  for (size_t first = 0; first < motions.size(); first += kTestBatch) {
    std::vector<Sequence> sequences;
    for (size_t i = first; i < std::min(first + kTestBatch, motions.size()); ++i) {
      sequences.push_back(WithFollower(dataset, motions[i]));
    }
    batches.push_back(MakeMotionBatch(dataset, sequences));
  }
  return batches;
}

// How people differ, and what a short capture leaves out.
TrainingOptions::Augmentation Variations() {
  TrainingOptions::Augmentation augmentation;
  augmentation.body_scale = 0.1;
  augmentation.leader_yaw = 0;
  augmentation.crop = 0.3;
  return augmentation;
}

TrainingOptions::Optimiser OptimiserSettings(const ClassifierOptions& options) {
  TrainingOptions::Optimiser settings;
  settings.learning_rate = options.learning_rate;
  settings.weight_decay = options.weight_decay;
  settings.gradient_clip = 1;
  return settings;
}

// The batches of one epoch: every motion once, varied, in an order drawn anew.
std::vector<MotionBatch> EpochBatches(const Dataset& dataset,
                                      const std::vector<Sequence>& sequences,
                                      const ClassifierOptions& options, int64_t epoch) {
  EpochRandom random(options.seed, epoch);
  std::vector<Sequence> varied;
  for (const Sequence& sequence : sequences) {
    varied.push_back(Augment(dataset, sequence, Variations(), &random));
  }
  for (size_t i = varied.size(); i > 1; --i) {
    std::swap(varied[i - 1], varied[static_cast<size_t>(random.Below(static_cast<int64_t>(i)))]);
  }
  std::vector<MotionBatch> batches;
  const size_t size = static_cast<size_t>(options.batch);
  for (size_t first = 0; first < varied.size(); first += size) {
    const auto begin = varied.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(size, varied.size() - first));
    batches.push_back(MakeMotionBatch(dataset, {begin, end}));
  }
  return batches;
}

void TrainNetwork(const Dataset& dataset, const std::vector<Sequence>& sequences,
                  const ClassifierOptions& options, Discriminator* network) {
  const int64_t count = static_cast<int64_t>(sequences.size());
  const int64_t steps = options.epochs * ((count + options.batch - 1) / options.batch);
  Optimiser optimiser(OptimiserSettings(options), (*network)->parameters(), steps);
  int64_t step = 0;
  (*network)->train();
  for (int64_t epoch = 0; epoch < options.epochs; ++epoch) {
    for (const MotionBatch& batch : EpochBatches(dataset, sequences, options, epoch)) {
      torch::cross_entropy_loss((*network)->forward(batch.motion, batch.lengths), batch.classes)
          .backward();
      optimiser.Step(step++);
    }
  }
  (*network)->eval();
}

std::string HashOf(const Discriminator& network) {
  std::string bytes;
  for (const torch::Tensor& parameter : network->parameters()) {
    const torch::Tensor values = parameter.detach().contiguous();
    bytes.append(reinterpret_cast<const char*>(values.data_ptr<float>()), values.nbytes());
  }
  return Sha256Hex(bytes);
}

absl::Status CheckMotions(const Dataset& dataset, const std::vector<ScoredMotion>& motions) {
  std::vector<int> counts(dataset.classes.size());
  for (const ScoredMotion& motion : motions) {
    const Sequence& sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
    ++counts[static_cast<size_t>(sequence.interaction_class)];
  }
  for (size_t c = 0; c < counts.size(); ++c) {
    if (counts[c] > 0) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("motions: none of class ", dataset.classes[c], ", wanted at least one"));
  }
  return absl::OkStatus();
}

void AppendRows(const torch::Tensor& rows, std::vector<std::vector<float>>* out) {
  const torch::Tensor values = rows.contiguous();
  const float* row = values.data_ptr<float>();
  for (int64_t i = 0; i < values.size(0); ++i, row += values.size(1)) {
    out->emplace_back(row, row + values.size(1));
  }
}

}  // namespace

absl::StatusOr<MotionClassifier> MotionClassifier::Train(const Dataset& dataset,
                                                         const std::vector<ScoredMotion>& motions,
                                                         const ClassifierOptions& options) {
  absl::Status status = CheckMotions(dataset, motions);
  if (!status.ok()) return status;
  network::DiscriminatorOptions sizes;
  sizes.input = 3 * dataset.skeleton.joint_count();
  sizes.window_frames = dataset.LongestFrameCount();
  sizes.hidden = options.hidden;
  sizes.outputs = dataset.class_count();
  std::vector<Sequence> sequences;
  for (const ScoredMotion& motion : motions) sequences.push_back(WithFollower(dataset, motion));
  torch::manual_seed(options.seed);
  auto model = std::make_shared<Model>();
  model->network = Discriminator(sizes);
  model->network->set_dropout(options.dropout);
  TrainNetwork(dataset, sequences, options, &model->network);
  model->hash = HashOf(model->network);
  return MotionClassifier(std::move(model));
}

std::vector<std::vector<float>> MotionClassifier::Probabilities(
    const Dataset& dataset, const std::vector<ScoredMotion>& motions) const {
  torch::NoGradGuard no_grad;
  std::vector<std::vector<float>> rows;
  for (const MotionBatch& batch : TestBatches(dataset, motions)) {
    AppendRows(model_->network->forward(batch.motion, batch.lengths).softmax(1), &rows);
  }
  return rows;
}

FeatureSet MotionClassifier::Features(const Dataset& dataset,
                                      const std::vector<ScoredMotion>& motions) const {
  torch::NoGradGuard no_grad;
  FeatureSet rows;
  for (const MotionBatch& batch : TestBatches(dataset, motions)) {
    AppendRows(model_->network->Features(batch.motion, batch.lengths), &rows);
  }
  return rows;
}

const std::string& MotionClassifier::hash() const { return model_->hash; }

}  // namespace duet
