#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/measures.h"
#include "model/evaluation/report/report.h"
#include "model/training/augment.h"

namespace duet::evaluation::program {
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

struct AugmentationFlags : ExperimentFlags {
  std::vector<uint64_t> seeds = {1, 2, 3, 4, 5};
  int64_t epochs = judge::MotionClassifierOptions().epochs;
  int match = 25, mix = 25;
};

// A half of the data, and the synthetic motions that its generator made from it.
struct DataHalf {
  dataset::Split split;
  std::vector<dataset::Sequence> synthetic;
};

absl::StatusOr<DataHalf> PrepareHalf(const dataset::Dataset& dataset, const FoldModel& model,
                                     const AugmentationFlags& flags, uint64_t seed) {
  DataHalf half;
  DUET_TRY(half.split, SplitInHalves(dataset, seed));
  DUET_TRY(const SharedSynthesizer synthesizer, model.load(absl::StrCat("half-", seed)));
  DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, "none"));
  const std::vector<SyntheticJob> jobs =
      PlanSyntheticSet(dataset, half.split.train, flags.match, flags.mix, seed);
  std::vector<LabelledLeader> leaders;
  for (const SyntheticJob& job : jobs) leaders.push_back({&job.sequence, job.labels});
  DUET_TRY(std::vector<motion::Poses> followers, SynthesizeSequences(*synthesizer, leaders, {}));
  for (size_t i = 0; i < jobs.size(); ++i) {
    half.synthetic.push_back(jobs[i].sequence);
    half.synthetic.back().pair.follower.poses = std::move(followers[i]);
  }
  return half;
}

// The accuracies of one kind of training data. Shapes: trials [halves][classes + 1]: of each class,
// then their mean.
struct Row {
  std::string name;
  bool captured, synthetic;  // what a classifier learns from
  std::vector<std::vector<double>> trials = {};
};

// The accuracies of a classifier on captured followers.
absl::StatusOr<std::vector<double>> Accuracies(const dataset::Dataset& dataset,
                                               const DataHalf& half, const Row& row,
                                               int64_t epochs) {
  // Synthetic pairs have their own leaders: they are added to the data set like captured ones.
  dataset::Dataset all = dataset;
  std::vector<int> train;
  if (row.captured) train = half.split.train;
  for (size_t i = 0; row.synthetic && i < half.synthetic.size(); ++i) {
    train.push_back(static_cast<int>(all.sequences.size()));
    all.sequences.push_back(half.synthetic[i]);
  }
  judge::MotionClassifierOptions options;
  // Longer training changes the accuracy by itself, and more motions mean more steps per epoch:
  // every row takes as many steps as the captured motions do.
  const double share =
      static_cast<double>(half.split.train.size()) / static_cast<double>(train.size());
  options.epochs = std::max<int64_t>(1, std::llround(static_cast<double>(epochs) * share));
  options.seed = 1;
  DUET_TRY(const judge::MotionClassifier classifier,
           judge::MotionClassifier::Train(all, metrics::CapturedMotions(all, train), options));
  std::vector<double> accuracies = metrics::AccuracyByClass(
      {classifier.Judge(all, metrics::CapturedMotions(all, half.split.test))},
      dataset.class_count());
  accuracies.push_back(base::Mean(accuracies));
  return accuracies;
}

double Deviation(const std::vector<double>& values) { return base::Summarise(values).deviation; }

std::vector<report::Table> Tables(const std::vector<std::string>& classes,
                                  const std::vector<Row>& rows) {
  std::vector<report::Table> tables = {
      {"Accuracy on captured followers"},
      {"Gain over captured followers alone, paired, and its standard deviation"}};
  for (report::Table& table : tables) {
    table.columns = classes;
    table.columns.emplace_back("mean");
    table.decimals = 3;
  }
  tables[0].best = report::Best::kHighest;
  for (const Row& row : rows) {
    tables[0].rows.push_back({row.name, report::ColumnMeans(row.trials)});
    if (&row == &rows.front()) continue;
    std::vector<std::vector<double>> gains = row.trials;
    for (size_t t = 0; t < gains.size(); ++t) {
      for (size_t c = 0; c < gains[t].size(); ++c) gains[t][c] -= rows.front().trials[t][c];
    }
    tables[1].rows.push_back({row.name, report::ColumnMeans(gains)});
    tables[1].rows.push_back({row.name + ", deviation", report::OverColumns(gains, Deviation)});
  }
  AddPrintedRows(report::PaperAugmentation(), &tables[0]);
  return tables;
}

absl::StatusOr<report::Section> RunAugmentation(const AugmentationFlags& flags) {
  DUET_TRY(const dataset::Dataset dataset, dataset::ReadDataset(flags.data));
  DUET_TRY(const std::vector<FoldModel> models, OpenModels(flags));
  if (models.size() != 1 || dataset.class_count() < 2) {
    return absl::InvalidArgumentError(
        "augmentation: expected one model and data of at least two classes, got others");
  }
  std::vector<Row> rows = {
      {"captured", true, false},
      {absl::StrCat("captured + ", flags.match, " match + ", flags.mix, " mix"), true, true},
      {"synthetic alone", false, true}};
  for (const uint64_t seed : flags.seeds) {
    DUET_TRY(const DataHalf half, PrepareHalf(dataset, models.front(), flags, seed));
    for (Row& row : rows) {
      DUET_TRY(row.trials.emplace_back(), Accuracies(dataset, half, row, flags.epochs));
      std::cerr << "half " << seed << ", " << row.name << ": " << row.trials.back().back() << "\n";
    }
  }
  report::Section section;
  section.text = {
      "A classifier with the architecture of the discriminator learns to classify the follower's "
      "motion from half of the captured clips of each class, with and without synthetic followers, "
      "and is tested on the captured clips of the other half. The generator of the synthetic "
      "followers was trained on the same half only, and answers varied leaders of that half. Rows "
      "take equally many training steps, since longer training alone moves the accuracy. "
      "\"Synthetic alone\" never sees a captured follower."};
  section.tables = Tables(dataset.classes, rows);
  section.settings = {{"data", DescribeData(dataset)}};
  return section;
}

}  // namespace

std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train, int match, int mix,
                                           uint64_t seed) {
  base::Random random(seed, 0);
  std::vector<SyntheticJob> jobs;
  for (int c = 0; c < dataset.class_count(); ++c) {
    std::vector<int> leaders;
    for (const int index : train) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      if (sequence.interaction_class == c) leaders.push_back(index);
    }
    random.Shuffle(&leaders);
    for (int i = 0; i < match + mix; ++i) {
      const int leader = leaders[static_cast<size_t>(i) % leaders.size()];
      SyntheticJob& job = jobs.emplace_back();
      job.sequence =
          Augment(dataset, dataset.sequences[static_cast<size_t>(leader)], Variations(), &random);
      job.sequence.pair.follower.poses = {};
      job.labels = DrawLabels(dataset.class_count(), c, i >= match, &random);
    }
  }
  return jobs;
}

Measure AddAugmentationCommand(CLI::App* command) {
  const auto flags = std::make_shared<AugmentationFlags>();
  AddFolder("--data", &flags->data, "folder of captures (docs/datasets.md)", command)->required();
  AddModelFlags(flags.get(), command);
  AddOption("--seeds", &flags->seeds,
            "seeds of the halves; reads <runs>/half-<seed> of duet-train --protocol half", command)
      ->delimiter(',');
  AddNumber("--epochs", &flags->epochs, 1, 100000, "epochs of a classifier on the captured half",
            command);
  AddNumber("--match", &flags->match, 1, 10000, "synthetic motions per class with only its label",
            command);
  AddNumber("--mix", &flags->mix, 0, 10000, "synthetic motions per class, mixed with another class",
            command);
  return [flags] { return RunAugmentation(*flags); };
}

}  // namespace duet::evaluation::program
