#include "model/evaluation/experiments/synthetic_plan.h"

#include <cstddef>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"
#include "model/training/augment.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kLeastOwn = 0.75, kMostOwn = 1.25, kMostOwnMixed = 1;
constexpr double kLeastOther = 0.1, kMostOther = 0.35;

training::TrainingOptions::Augmentation Variations() {
  training::TrainingOptions::Augmentation augmentation;
  augmentation.swap_roles = 0.5;
  augmentation.body_scale = 0.08;
  augmentation.time_warp = 0.1;
  augmentation.leader_yaw = 0.1;
  return augmentation;
}

std::vector<int> OfClass(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                         int interaction_class) {
  std::vector<int> found;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class == interaction_class) found.push_back(index);
  }
  return found;
}

int DrawOtherClass(int classes, int own, base::Random* random) {
  const int drawn = static_cast<int>(random->Below(classes - 1));
  return drawn < own ? drawn : drawn + 1;
}

std::vector<float> DrawLabels(int classes, int own, bool mix, base::Random* random) {
  std::vector<float> labels(static_cast<size_t>(classes), 0);
  const double weight = random->Uniform(kLeastOwn, mix ? kMostOwnMixed : kMostOwn);
  labels[static_cast<size_t>(own)] = static_cast<float>(weight);
  if (!mix) return labels;
  const int other = DrawOtherClass(classes, own, random);
  labels[static_cast<size_t>(other)] = static_cast<float>(random->Uniform(kLeastOther, kMostOther));
  return labels;
}

// A class's name as part of a file's.
std::string FileName(std::string name) {
  for (char& c : name) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

dataset::Sequence DrawLeader(const dataset::Dataset& dataset, const dataset::Sequence& captured,
                             base::Random* random) {
  dataset::Sequence sequence = Augment(dataset, captured, Variations(), random);
  sequence.pair.follower.poses = {};
  return sequence;
}

}  // namespace

std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train,
                                           const SyntheticPlanOptions& options) {
  base::Random random(options.seed, 0);
  std::vector<SyntheticJob> jobs;
  for (int c = 0; c < dataset.class_count(); ++c) {
    std::vector<int> leaders = OfClass(dataset, train, c);
    random.Shuffle(&leaders);
    for (int i = 0; i < options.match + options.mix; ++i) {
      const int leader = leaders[static_cast<size_t>(i) % leaders.size()];
      SyntheticJob job;
      job.sequence = DrawLeader(dataset, dataset.sequences[static_cast<size_t>(leader)], &random);
      job.sequence.id = absl::StrFormat(
          "%s-%03d", FileName(dataset.classes[static_cast<size_t>(c)]), jobs.size() + 1);
      job.labels = DrawLabels(dataset.class_count(), c, i >= options.match, &random);
      jobs.push_back(std::move(job));
    }
  }
  return jobs;
}

}  // namespace duet::evaluation::experiments
