#include "model/training/flow_trainer.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "model/motion/skeleton.h"
#include "model/network/batch.h"
#include "model/network/flow_noise.h"
#include "model/network/flow_sampler.h"
#include "model/network/losses.h"
#include "model/network/parameters.h"
#include "model/training/flow_batches.h"

namespace duet::training {
namespace {

network::FlowGenerator MakeGenerator(const TrainingOptions& options,
                                     const checkpoint::Manifest& manifest) {
  torch::manual_seed(options.common.seed());
  network::FlowGenerator generator(manifest);
  generator->set_dropout(options.flow.flow().dropout());
  return generator;
}

// Velocities are about an eighth as large as positions; this gives both about the same weight.
constexpr double kVelocityScale = 8;

// The fraction that the average keeps after a step: smaller at first, because the average then
// consists of early weights.
double AverageDecay(double decay, int64_t step) {
  const double steps = static_cast<double>(step + 1);
  return std::min(decay, (1 + steps) / (10 + steps));
}

}  // namespace

FlowTrainer::FlowTrainer(const TrainingOptions& options, const checkpoint::Manifest& manifest,
                         const dataset::Dataset& dataset, std::vector<int> train,
                         std::vector<int> validation)
    : EpochTrainer(options, manifest, dataset, std::move(train), std::move(validation)),
      flow_(options.flow),
      architecture_(std::get<checkpoint::FlowArchitecture>(manifest.architecture)),
      hands_(motion::FindHands(dataset.skeleton)),
      steps_per_epoch_(StepsPerEpoch(options, train_.size())),
      generator_(MakeGenerator(options, manifest)),
      optimiser_(options.common.optimiser(), generator_->parameters(),
                 steps_per_epoch_ * options.common.epochs()) {
  const FlowStatistics statistics =
      MeasureFollowers(manifest, dataset, train_, flow_.flow().target_smoothing());
  generator_->SetMeasured(statistics.base_poses, statistics.noise_roots);
  base_poses_ = generator_->base_poses().clone();
  class_weights_ = statistics.spreads.pow(-flow_.flow().class_balance());
  class_weights_ /= class_weights_.mean();
  Begin(generator_.get());
}

absl::Status FlowTrainer::UseDevice(const std::string& device) {
  if (device != "cpu" && !torch::cuda::is_available()) {
    return absl::FailedPreconditionError(absl::StrCat(
        "device: expected one that LibTorch can use (cpu; cuda if LibTorch was built with it and "
        "finds an accelerator), got ",
        device));
  }
  generator_->to(torch::Device(device));
  Begin(generator_.get());
  return absl::OkStatus();
}

torch::Tensor FlowTrainer::DrawSource(const FlowBatch& batch) const {
  return network::SourceNoise(
      architecture_.noise, generator_->noise_roots(), batch.input.known_count,
      network::RandomNumbers(batch.target, batch.live, architecture_.noise.frame_length));
}

torch::Tensor FlowTrainer::ClipWeights(const FlowBatch& batch) const {
  const torch::Tensor labels = batch.labels.clamp_min(0);
  const torch::Tensor more = class_weights_.to(labels.device()) - 1;
  return 1 + labels.matmul(more) / labels.sum(1).clamp_min(1);
}

template <typename Add>
void FlowTrainer::AddBodyScores(const FlowBatch& batch, const torch::Tensor& answers,
                                const Add& add, EpochReport* report) {
  const FlowSettings::Energy& energy = flow_.energy();
  const torch::Tensor& lengths = batch.input.lengths;
  const motion::Skeleton& skeleton = manifest_.model.skeleton;
  const torch::Tensor base = batch.input.base.unsqueeze(1) / architecture_.offset_scale;
  if (energy.feet_weight() > 0 && skeleton.feet) {
    // The motion of a foot, in offsets per frame, below which it stands.
    const double still =
        flow_.flow().slide_speed() / manifest_.model.frame_rate_hz / architecture_.offset_scale;
    const auto motions = [&](const torch::Tensor& motion) {
      return network::FootMotions(motion, *skeleton.feet, still);
    };
    add(energy.feet_weight(),
        network::EnergyScores(motions(answers), motions(batch.target), lengths - 1),
        &report->continuity);
  }
  if (energy.hands_weight() > 0 && hands_) {
    const double scale = architecture_.offset_scale;
    const auto places = [&](const torch::Tensor& offsets) {
      return network::HandPlaces(offsets + base, batch.input.leader / scale, *hands_,
                                 energy.near_hands() / scale);
    };
    add(energy.hands_weight(),
        network::EnergyScores(places(answers), places(batch.target), lengths),
        &report->reconstruction);
  }
}

torch::Tensor FlowTrainer::EnergyLoss(const FlowBatch& batch, EpochReport* report) {
  const FlowSettings::Energy& energy = flow_.energy();
  const torch::Tensor& lengths = batch.input.lengths;
  std::vector<torch::Tensor> sources;
  for (int64_t a = 0; a < energy.answers(); ++a) sources.push_back(DrawSource(batch));
  const torch::Tensor answers = network::PlainAnswers(generator_, architecture_, batch.input,
                                                      batch.labels, torch::stack(sources));
  torch::Tensor total = torch::zeros({}, batch.target.options());
  const torch::Tensor clip_weights = ClipWeights(batch);
  const auto add = [&](double weight, const torch::Tensor& scores, double* mean) {
    const torch::Tensor loss = (clip_weights * scores).mean();
    total = total + weight * loss;
    means_.Add(mean, loss);
  };
  add(1, network::EnergyScores(answers, batch.target, lengths), &report->reconstruction);
  const double rate = kVelocityScale;
  add(energy.velocity_weight(),
      network::VelocityEnergyScores(rate * answers, rate * batch.target, lengths),
      &report->continuity);
  add(energy.block_weight(),
      network::BlockEnergyScores(rate * answers, rate * batch.target, lengths,
                                 energy.block_frames()),
      &report->continuity);
  AddBodyScores(batch, answers, add, report);
  means_.Add(&report->generator, total);
  return total;
}

torch::Tensor FlowTrainer::MatchingLoss(const FlowBatch& batch, EpochReport* report) {
  const torch::Tensor& lengths = batch.input.lengths;
  const torch::Tensor noise = DrawSource(batch);
  const torch::Tensor times = torch::rand({batch.target.size(0)}, batch.target.options());
  const torch::Tensor sample = torch::lerp(noise, batch.target, times.view({-1, 1, 1}));
  const torch::Tensor predicted =
      generator_->forward(generator_->Prepare(batch.input), batch.labels, sample, times);
  torch::Tensor losses = torch::zeros_like(times);
  const auto add = [&](double weight, const torch::Tensor& loss, double* mean) {
    losses = losses + weight * loss;
    means_.Add(mean, loss.mean());
  };
  add(1, network::SquaredErrors(predicted, batch.target, lengths), &report->reconstruction);
  add(flow_.flow().difference_weight(),
      network::SquaredDifferenceErrors(predicted, batch.target, lengths), &report->continuity);
  const torch::Tensor base = batch.input.base.unsqueeze(1) / architecture_.offset_scale;
  if (flow_.flow().bone_weight() > 0) {
    add(flow_.flow().bone_weight(),
        network::SquaredBoneErrors(predicted + base, batch.target + base, lengths,
                                   manifest_.model.skeleton.bones),
        &report->bone);
  }
  losses = losses * ClipWeights(batch).square();  // of squared errors
  const torch::Tensor total =
      (losses / (1 - times).clamp_min(flow_.flow().least_remaining())).mean();
  means_.Add(&report->generator, total);
  return total;
}

bool FlowTrainer::ScoresAnswers(int64_t epoch) const {
  return static_cast<double>(epoch) >=
         flow_.energy().from() * static_cast<double>(options_.common.epochs());
}

bool FlowTrainer::MayBeBest(int64_t epoch) const {
  return ScoresAnswers(epoch) || !ScoresAnswers(options_.common.epochs() - 1);
}

FlowEpoch FlowTrainer::TakeEpoch() {
  const auto draw = [this](int64_t number) {
    return DrawFlowEpoch(manifest_, dataset_, train_, options_, number);
  };
  FlowEpoch taken = drawn_epoch_ == epoch() && drawn_.valid() ? drawn_.get() : draw(epoch());
  drawn_epoch_ = epoch() + 1;
  if (drawn_epoch_ < options_.common.epochs()) {
    drawn_ = std::async(std::launch::async, draw, drawn_epoch_);
  }
  return taken;
}

FlowBatch FlowTrainer::NextBatch(base::Random* random, std::vector<FlowExample>* examples) const {
  if (ScoresAnswers(epoch()) && flow_.own().share() > 0) {
    const auto answer = [this](absl::Span<const engine::NetworkInput> inputs) {
      const torch::NoGradGuard no_grad;
      return network::TakeAll(network::AnswerWindows(generator_, manifest_, inputs), inputs);
    };
    ContinueOwnMotion(dataset_.skeleton, flow_.own(), answer, random, examples);
  }
  FlowBatch batch = MakeFlowBatch(manifest_, base_poses_, *examples);
  batch.input = batch.input.To(generator_->device());
  batch.labels = batch.labels.to(generator_->device());
  batch.target = batch.target.to(generator_->device());
  if (batch.live.defined()) batch.live = batch.live.to(generator_->device());
  return batch;
}

void FlowTrainer::TrainEpoch(int64_t first_step, EpochReport* report) {
  const bool is_energy = ScoresAnswers(epoch());
  report->whole_answers = is_energy;
  // Answers in use have none of the spread that dropout adds in training.
  generator_->set_dropout(is_energy ? 0 : flow_.flow().dropout());
  base::Random random(options_.common.seed(),
                      epoch() + options_.common.epochs());  // not that of the epoch's clips
  int64_t step = first_step;
  for (std::vector<FlowExample>& examples : TakeEpoch()) {
    const FlowBatch batch = NextBatch(&random, &examples);
    (is_energy ? EnergyLoss(batch, report) : MatchingLoss(batch, report)).backward();
    optimiser_.Step(step);
    UpdateAverage(AverageDecay(options_.common.optimiser().average_decay(), step));
    ++step;
  }
  means_.Write(steps_per_epoch_);
}

double FlowTrainer::ValidationError(const Example& example) {
  FlowExample captured = MakeFlowExample(manifest_, dataset_, example, 0);
  captured.input.sampling.variety = 0;
  const torch::Tensor answer = network::AnswerWindows(generator_, manifest_, {&captured.input, 1});
  const torch::Tensor follower = network::PadPoses({&captured.target}, answer.size(1));
  return network::NormLoss(answer, follower, torch::tensor({answer.size(1)})).item<double>();
}

std::vector<checkpoint::Tensor> FlowTrainer::BestTensors() {
  network::FlowGenerator best(manifest_);
  best->SetMeasured(base_poses_, flow_.flow().noise_share() * generator_->noise_roots());
  CopyBest(best.get());
  return network::StoreParameters(manifest_, best);
}

absl::Status FlowTrainer::LoadWeights(const checkpoint::Checkpoint& checkpoint) {
  const torch::Tensor base_poses = generator_->base_poses().clone(),
                      noise_roots = generator_->noise_roots().clone();
  const absl::Status loaded = network::LoadParameters(checkpoint, generator_);
  generator_->SetMeasured(base_poses, noise_roots);
  return loaded;
}

std::vector<std::pair<std::string, torch::optim::Optimizer*>> FlowTrainer::StateOptimisers() {
  return {{"optimiser", &optimiser_.state()}};
}

}  // namespace duet::training
