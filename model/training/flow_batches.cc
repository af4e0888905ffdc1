#include "model/training/flow_batches.h"

#include <algorithm>

#include "model/engine/windows.h"
#include "model/motion/filter.h"
#include "model/network/batch.h"
#include "model/training/augment.h"
#include "model/training/sampler.h"

namespace duet::training {
namespace {

constexpr int kFewestSeveral = 2;

// Replaces a known first pose by several known frames, up to half of the clip.
void TellSeveral(const motion::Poses& target, base::Random* random, engine::NetworkInput* input) {
  const int most = target.frame_count() / 2;
  if (most < kFewestSeveral) return;
  const int count = kFewestSeveral + static_cast<int>(random->Below(most - kFewestSeveral + 1));
  input->settled = target;
  input->settled.Resize(count);
}

// Adds an error to the known frames: a constant offset for each joint.
void Disturb(double deviation, base::Random* random, engine::NetworkInput* input) {
  if (!input->start) return;
  std::vector<motion::Vec3>& pose = input->start->pose;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const motion::Vec3 by = Normal3(deviation, random);
    pose[j] += by;
    for (int t = 0; t < input->settled.frame_count(); ++t) input->settled[t][j] += by;
  }
}

void Scale(float scale, absl::Span<motion::Vec3> points) {
  for (motion::Vec3& point : points) point = point * scale;
}

// Scales both people by one factor about the leader's first root.
void ScalePair(float scale, FlowExample* example) {
  Scale(scale, example->target.all());
  Scale(scale, example->input.leader.all());
  Scale(scale, example->input.settled.all());
  if (!example->input.start) return;
  example->input.start->root = example->input.start->root * scale;
  Scale(scale, absl::MakeSpan(example->input.start->pose));
}

// States the partner's direction in half of the clips without a start if the capture's setup does
// not define it: a request may state it too. In the other half the frame is that of the leader's
// hips.
void TellDirection(int root, base::Random* random, Example* example) {
  dataset::Sequence& sequence = example->sequence;
  if (example->start != StartKnowledge::kNone || sequence.partner_direction) return;
  if (!random->Chance(0.5)) return;
  const motion::Vec3 toward = sequence.pair.follower.at(0, root) - sequence.pair.leader.at(0, root);
  if (toward.x != 0 || toward.z != 0) sequence.partner_direction = {toward.x, 0, toward.z};
}

FlowExample DrawExample(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                        const dataset::Sequence& sequence, bool needs_pose,
                        const TrainingOptions& options, base::Random* random) {
  const FlowSettings& flow = options.flow;
  const bool live = flow.live().share() > 0 && random->Chance(flow.live().share());
  const bool goes_on = live && random->Chance(flow.live().several_known());
  const StartKnowledge start =
      goes_on || needs_pose ? StartKnowledge::kPose : DrawStart(options.common.start(), random);
  Example captured = CapturedExample(dataset, sequence, start);
  TellDirection(dataset.skeleton.root, random, &captured);
  FlowExample example =
      MakeFlowExample(manifest, dataset, captured, flow.flow().target_smoothing());
  example.live = live;
  if (goes_on || (start == StartKnowledge::kPose && random->Chance(flow.flow().several_known()))) {
    TellSeveral(example.target, random, &example.input);
  }
  Disturb(flow.flow().known_noise(), random, &example.input);
  if (start == StartKnowledge::kPose && random->Chance(flow.drift().share())) {
    AddDrift(dataset.skeleton, flow.drift(), random, &example.input, &example.target);
  }
  if (std::get<checkpoint::FlowArchitecture>(manifest.architecture).frame_labels) {
    example.input.labels =
        DrawFrameLabels(sequence, dataset.class_count(), flow.frame_labels(), random);
  }
  ScalePair(
      static_cast<float>(1 + random->Uniform(-flow.flow().pair_scale(), flow.flow().pair_scale())),
      &example);
  if (live)
    HideFuture(dataset.skeleton, manifest.model.frame_rate_hz, flow.live(), random, &example);
  return example;
}

// The clips of a pass, and for each whether it needs a start pose, or has no label.
struct Clips {
  std::vector<dataset::Sequence> sequences;
  std::vector<bool> needs_pose, unlabelled;
};

// Every training sequence, augmented, some of them with pauses.
Clips DrawClips(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                const std::vector<int>& train, const TrainingOptions& options,
                base::Random* random) {
  const FlowSettings& flow = options.flow;
  const bool still = UsesStillness(flow);
  TrainingOptions first = options;
  if (still) {  // the noise is added after the pauses
    first.common.mutable_augmentation()->set_noise(0);
    first.common.mutable_augmentation()->set_body_noise(0);
  }
  Clips clips{AugmentAll(dataset, train, first, random), std::vector<bool>(train.size()),
              std::vector<bool>(train.size())};
  for (size_t i = 0; still && i < train.size(); ++i) {
    dataset::Sequence& sequence = clips.sequences[i];
    StillClip clip = AddStillness(dataset.skeleton, flow.stillness(), dataset.frame_rate_hz,
                                  manifest.model.window_frames, random, std::move(sequence));
    clips.needs_pose[i] = clip.amid;
    clips.unlabelled[i] = clip.unlabelled;
    sequence = std::move(clip.sequence);
    if (!random->Chance(flow.stillness().clean())) {
      DisturbLeader(options.common.augmentation(), random, &sequence.pair.leader);
    }
  }
  return clips;
}

int64_t BatchesPerPass(const TrainingOptions& options, size_t sequences) {
  const int64_t batches =
      (static_cast<int64_t>(sequences) + options.common.batch() - 1) / options.common.batch();
  return std::max<int64_t>(1, batches);
}

}  // namespace

FlowExample MakeFlowExample(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                            const Example& example, double smoothing) {
  const engine::SynthesisWindow window = MakeWindow(dataset, example);
  const motion::Standardisation frame =
      WindowStandardisation(dataset.skeleton, window, manifest.standardisation);
  return {Standardise(frame, window),
          frame.Apply(motion::GaussianFilter(example.target, smoothing))};
}

int64_t PassesPerEpoch(const TrainingOptions& options, size_t sequences) {
  const FlowSettings& flow = options.flow;
  const int64_t steps =
      BatchesPerPass(options, sequences) * options.common.epochs();  // of one pass each
  return std::max(flow.flow().passes(), (flow.flow().least_steps() + steps - 1) / steps);
}

int64_t StepsPerEpoch(const TrainingOptions& options, size_t sequences) {
  return BatchesPerPass(options, sequences) * PassesPerEpoch(options, sequences);
}

FlowBatch MakeFlowBatch(const checkpoint::Manifest& manifest, const torch::Tensor& base_poses,
                        const std::vector<FlowExample>& examples) {
  std::vector<engine::NetworkInput> inputs;
  std::vector<const motion::Poses*> targets;
  for (const FlowExample& example : examples) {
    inputs.push_back(example.input);
    targets.push_back(&example.target);
  }
  FlowBatch batch;
  batch.input = network::MakeFlowInput(manifest, base_poses, inputs);
  batch.labels = batch.input.labels.select(1, 0).clone();
  batch.target =
      (network::PadPoses(targets, batch.input.leader.size(1)) - batch.input.base.unsqueeze(1)) /
      std::get<checkpoint::FlowArchitecture>(manifest.architecture).offset_scale;
  const bool has_live = std::any_of(examples.begin(), examples.end(),
                                    [](const FlowExample& example) { return example.live; });
  if (has_live) batch.live = torch::zeros({batch.target.size(0), 1, 1}, torch::kBool);
  for (std::size_t n = 0; n < examples.size(); ++n) {
    const auto row = static_cast<int64_t>(n);
    if (has_live) batch.live[row].fill_(examples[n].live);
    if (!examples[n].unlabelled) continue;
    batch.labels[row].zero_();
    batch.input.labels[row].zero_();
  }
  return batch;
}

FlowEpoch DrawFlowEpoch(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                        const std::vector<int>& train, const TrainingOptions& options,
                        int64_t epoch) {
  const FlowSettings& flow = options.flow;
  base::Random random(options.common.seed(), epoch);
  FlowEpoch batches;
  const int64_t passes = PassesPerEpoch(options, train.size());
  for (int64_t pass = 0; pass < passes; ++pass) {
    const Clips clips = DrawClips(manifest, dataset, train, options, &random);
    for (const std::vector<int>& piece :
         BatchesByLength(clips.sequences, options.common.batch(), &random)) {
      std::vector<FlowExample>& examples = batches.emplace_back();
      for (const int index : piece) {
        const auto i = static_cast<size_t>(index);
        examples.push_back(DrawExample(manifest, dataset, clips.sequences[i], clips.needs_pose[i],
                                       options, &random));
        examples.back().unlabelled = random.Chance(flow.flow().unlabelled()) || clips.unlabelled[i];
      }
    }
  }
  return batches;
}

namespace {

constexpr double kSmallestVariance = 1e-6;

// One training follower in the standard coordinates.
struct Follower {
  int64_t interaction_class;
  std::vector<dataset::LabelSpan> labels;  // at least one
  torch::Tensor motion;                    // [T, 3 J]
};

std::vector<Follower> Followers(const checkpoint::Manifest& manifest,
                                const dataset::Dataset& dataset, const std::vector<int>& train,
                                double smoothing) {
  const std::vector<int> mirrored = MirroredJoints(dataset.skeleton);
  std::vector<Follower> followers;
  for (const int index : train) {
    dataset::Sequence sequence = dataset.sequences[static_cast<size_t>(index)];
    for (const bool mirror : {false, true}) {
      if (mirror) Mirror(mirrored, &sequence);
      const motion::Poses poses =
          MakeFlowExample(manifest, dataset,
                          CapturedExample(dataset, sequence, StartKnowledge::kNone), smoothing)
              .target;
      const int frames = poses.frame_count();
      followers.push_back(
          {sequence.interaction_class, sequence.labels, network::PadPoses({&poses}, frames)[0]});
      std::vector<dataset::LabelSpan>& labels = followers.back().labels;
      if (labels.empty()) labels.push_back({sequence.interaction_class, 0, frames});
    }
  }
  return followers;
}

torch::Tensor ClassMeans(const std::vector<Follower>& followers, int64_t classes) {
  const int64_t width = followers.front().motion.size(1);
  torch::Tensor sums = torch::zeros({classes, width}), frames = torch::zeros({classes, 1});
  for (const Follower& follower : followers) {
    for (const dataset::LabelSpan& span : follower.labels) {
      sums[span.interaction_class] += follower.motion.slice(0, span.begin, span.end).sum(0);
      frames[span.interaction_class] += span.end - span.begin;
    }
  }
  return sums / frames.clamp_min(1);
}

torch::Tensor Spreads(const std::vector<Follower>& followers, const torch::Tensor& means) {
  torch::Tensor squares = torch::zeros({means.size(0)}), counts = torch::zeros({means.size(0)});
  for (const Follower& follower : followers) {
    const int64_t c = follower.interaction_class;
    squares[c] += (follower.motion - means[c]).square().mean();
    counts[c] += 1;
  }
  const torch::Tensor all = squares.sum() / counts.sum();
  return torch::where(counts > 0, squares / counts.clamp_min(1), all)
      .clamp_min(kSmallestVariance)
      .sqrt();
}

torch::Tensor SymmetricRoot(const torch::Tensor& covariance) {
  const auto [values, vectors] = torch::linalg_eigh(covariance.to(torch::kFloat64), "L");
  const torch::Tensor roots = values.clamp_min(kSmallestVariance).sqrt();
  return torch::matmul(vectors * roots, vectors.t()).to(torch::kFloat32);
}

}  // namespace

FlowStatistics MeasureFollowers(const checkpoint::Manifest& manifest,
                                const dataset::Dataset& dataset, const std::vector<int>& train,
                                double smoothing) {
  const double scale = std::get<checkpoint::FlowArchitecture>(manifest.architecture).offset_scale;
  const std::vector<Follower> followers = Followers(manifest, dataset, train, smoothing);
  FlowStatistics statistics;
  statistics.base_poses = ClassMeans(followers, manifest.model.class_count());
  const int64_t width = statistics.base_poses.size(1);
  torch::Tensor from_mean = torch::zeros({width, width}), from_first = torch::zeros({width, width});
  const auto add = [&](const Follower& follower, const torch::Tensor& base, torch::Tensor* sum) {
    const torch::Tensor offsets = (follower.motion - base) / scale;
    *sum += torch::matmul(offsets.t(), offsets) / offsets.size(0);
  };
  for (const Follower& follower : followers) {
    add(follower, statistics.base_poses[follower.interaction_class], &from_mean);
    add(follower, follower.motion[0], &from_first);
  }
  statistics.spreads = Spreads(followers, statistics.base_poses) / scale;
  const double count = static_cast<double>(followers.size());
  statistics.noise_roots =
      torch::stack({SymmetricRoot(from_mean / count), SymmetricRoot(from_first / count)});
  return statistics;
}

}  // namespace duet::training
