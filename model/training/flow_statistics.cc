#include "model/training/flow_statistics.h"

#include "model/network/batch.h"
#include "model/training/flow_batches.h"

namespace duet::training {
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
  const double count = static_cast<double>(followers.size());
  statistics.noise_roots =
      torch::stack({SymmetricRoot(from_mean / count), SymmetricRoot(from_first / count)});
  return statistics;
}

}  // namespace duet::training
