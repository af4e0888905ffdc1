#include "model/evaluation/experiments/augmentation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"
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

std::vector<float> DrawLabels(int classes, int own, bool mix, base::Random* random) {
  std::vector<float> labels(static_cast<size_t>(classes), 0);
  const double weight = random->Uniform(kLeastOwn, mix ? kMostOwnMixed : kMostOwn);
  labels[static_cast<size_t>(own)] = static_cast<float>(weight);
  if (!mix) return labels;
  int other = static_cast<int>(random->Below(classes - 1));
  if (other >= own) ++other;
  labels[static_cast<size_t>(other)] = static_cast<float>(random->Uniform(kLeastOther, kMostOther));
  return labels;
}

constexpr char kCapturedRow[] = "captured";

// A row of the tables: the training data of a classifier and its epochs.
struct Condition {
  std::string row;
  std::vector<int> captured;  // sequences of the data set
  bool synthetic;             // also, or only, the half's synthetic motions
  int64_t epochs;
};

// The epochs in which `motions` take as many steps as `captured` ones in `epochs`.
int64_t SameSteps(int64_t epochs, size_t captured, size_t motions) {
  const double share = static_cast<double>(captured) / static_cast<double>(motions);
  return std::max<int64_t>(1, std::llround(static_cast<double>(epochs) * share));
}

std::vector<Condition> Conditions(const DataHalf& half, const HalfOptions& options) {
  const std::vector<int>& captured = half.split.train;
  const size_t own = captured.size(), made = half.synthetic.size();
  const int64_t epochs = options.epochs;
  const std::string& both = options.synthetic_row;
  return {
      {kCapturedRow, captured, false, epochs},
      {both, captured, true, SameSteps(epochs, own, own + made)},
      {absl::StrCat(kCapturedRow, ", longer"), captured, false, SameSteps(epochs, own + made, own)},
      {absl::StrCat(both, ", longer"), captured, true, epochs},
      {"synthetic alone", {}, true, SameSteps(epochs, own, made)}};
}

// The accuracies of a classifier on captured followers: of each class, then their mean.
absl::StatusOr<std::vector<double>> Accuracies(const dataset::Dataset& dataset,
                                               const DataHalf& half, const Condition& condition,
                                               uint64_t seed) {
  // Synthetic pairs have their own leaders: they are added to the data set like captured ones.
  dataset::Dataset all = dataset;
  std::vector<int> train = condition.captured;
  for (size_t i = 0; condition.synthetic && i < half.synthetic.size(); ++i) {
    train.push_back(static_cast<int>(all.sequences.size()));
    all.sequences.push_back(half.synthetic[i]);
  }
  judge::MotionClassifierOptions options;
  options.epochs = condition.epochs;
  options.seed = seed;
  DUET_TRY(judge::MotionClassifier classifier,
           judge::MotionClassifier::Train(all, metrics::CapturedMotions(all, train), options));
  metrics::Confusion confusion(dataset.class_count());
  confusion.AddLikeliest(
      metrics::ClassesOf(dataset, half.split.test),
      classifier.Probabilities(all, metrics::CapturedMotions(all, half.split.test)));
  std::vector<double> accuracies = confusion.ClassAccuracies();
  accuracies.push_back(confusion.MeanClassAccuracy());
  return accuracies;
}

double ShareAboveZero(const std::vector<double>& values) {
  const auto above = std::count_if(values.begin(), values.end(), [](double v) { return v > 0; });
  return static_cast<double>(above) / static_cast<double>(values.size());
}

// A figure of each column over trials. Shapes: trials [trials][columns], at least one.
template <typename Figure>
std::vector<double> OverTrials(const std::vector<std::vector<double>>& trials, Figure figure) {
  std::vector<double> figures;
  for (size_t c = 0; c < trials.front().size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& trial : trials) values.push_back(trial[c]);
    figures.push_back(figure(values));
  }
  return figures;
}

}  // namespace

std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train,
                                           const SyntheticPlanOptions& options) {
  base::Random random(options.seed, 0);
  std::vector<SyntheticJob> jobs;
  for (int c = 0; c < dataset.class_count(); ++c) {
    std::vector<int> leaders;
    for (const int index : train) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      if (sequence.interaction_class == c) leaders.push_back(index);
    }
    random.Shuffle(&leaders);
    for (int i = 0; i < options.match + options.mix; ++i) {
      const int leader = leaders[static_cast<size_t>(i) % leaders.size()];
      SyntheticJob job;
      job.sequence =
          Augment(dataset, dataset.sequences[static_cast<size_t>(leader)], Variations(), &random);
      job.sequence.pair.follower.poses = {};
      job.sequence.id = absl::StrCat(dataset.classes[static_cast<size_t>(c)], "-", jobs.size() + 1);
      job.labels = DrawLabels(dataset.class_count(), c, i >= options.match, &random);
      jobs.push_back(std::move(job));
    }
  }
  return jobs;
}

absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs) {
  DUET_RETURN_IF_ERROR(CheckModelFits(synthesizer.description(), dataset));
  std::vector<dataset::Sequence> answered;
  for (const SyntheticJob& job : jobs) {
    absl::StatusOr<motion::Poses> follower =
        SynthesizeSequence(synthesizer, job.sequence, job.labels, StartGiven::kNone);
    if (!follower.ok()) {
      return absl::Status(follower.status().code(),
                          absl::StrCat(job.sequence.id, ": ", follower.status().message()));
    }
    answered.push_back(job.sequence);
    answered.back().pair.follower.poses = *std::move(follower);
  }
  return answered;
}

absl::Status RunHalf(const dataset::Dataset& dataset, const DataHalf& half,
                     const HalfOptions& options, std::ostream* progress,
                     std::vector<AccuracyRow>* rows) {
  const std::vector<Condition> conditions = Conditions(half, options);
  rows->resize(conditions.size());
  for (int repeat = 1; repeat <= options.repeats; ++repeat) {
    for (size_t i = 0; i < conditions.size(); ++i) {
      AccuracyRow& row = (*rows)[i];
      row.name = conditions[i].row;
      DUET_TRY(row.trials.emplace_back(),
               Accuracies(dataset, half, conditions[i], static_cast<uint64_t>(repeat)));
      *progress << "half " << half.seed << ", classifier " << repeat << ", " << row.name << ": "
                << row.trials.back().back() << std::endl;
    }
  }
  return absl::OkStatus();
}

std::vector<report::Table> AccuracyTables(const std::vector<std::string>& classes,
                                          const std::vector<AccuracyRow>& rows) {
  const auto mean = [](const std::vector<double>& values) { return base::Summarise(values).mean; };
  const auto deviation = [](const std::vector<double>& values) {
    return base::Summarise(values).deviation;
  };
  std::vector<report::Table> tables = {{"Accuracy on captured followers, mean over the trials"},
                                       {"Accuracy, standard deviation over the trials"},
                                       {"Gain over captured followers alone, paired"}};
  for (report::Table& table : tables) {
    table.columns = classes;
    table.columns.emplace_back("mean");
    table.decimals = 3;
  }
  tables[0].best = report::Best::kHighest;
  for (const AccuracyRow& row : rows) {
    tables[0].rows.push_back({row.name, OverTrials(row.trials, mean)});
    tables[1].rows.push_back({row.name, OverTrials(row.trials, deviation)});
    if (&row == &rows.front()) continue;
    std::vector<std::vector<double>> gains = row.trials;
    for (size_t t = 0; t < gains.size(); ++t) {
      for (size_t c = 0; c < gains[t].size(); ++c) gains[t][c] -= rows.front().trials[t][c];
    }
    tables[2].rows.push_back({row.name, OverTrials(gains, mean)});
    tables[2].rows.push_back({row.name + ", deviation", OverTrials(gains, deviation)});
    tables[2].rows.push_back({row.name + ", share above 0", OverTrials(gains, ShareAboveZero)});
  }
  return tables;
}

}  // namespace duet::evaluation::experiments
