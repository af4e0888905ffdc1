#include "model/evaluation/experiments/augmentation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/evaluation/experiments/answers.h"
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

// A class's name as part of a file's.
std::string FileName(std::string name) {
  for (char& c : name) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

double Mean(const std::vector<double>& values) { return base::Summarise(values).mean; }
double Deviation(const std::vector<double>& values) { return base::Summarise(values).deviation; }
double ShareAboveZero(const std::vector<double>& values) {
  const auto above = std::count_if(values.begin(), values.end(), [](double v) { return v > 0; });
  return values.empty() ? NAN : static_cast<double>(above) / static_cast<double>(values.size());
}

template <typename Rows>
auto Find(Rows& rows, const std::string& name) {
  return std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.first == name; });
}

// A row of the tables: the training data of a classifier and its epochs.
struct Condition {
  std::string row;
  TrainingMaterial material;
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
      {kCapturedRow, {captured, {}}, epochs},
      {both, {captured, half.synthetic}, SameSteps(epochs, own, own + made)},
      {absl::StrCat(kCapturedRow, ", longer"), {captured, {}}, SameSteps(epochs, own + made, own)},
      {absl::StrCat(both, ", longer"), {captured, half.synthetic}, epochs},
      {"synthetic alone", {{}, half.synthetic}, SameSteps(epochs, own, made)}};
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
      job.sequence.id = absl::StrFormat(
          "%s-%03d", FileName(dataset.classes[static_cast<size_t>(c)]), jobs.size() + 1);
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

void Trials::Add(const std::string& row, const std::string& trial, std::vector<double> values) {
  auto found = Find(rows_, row);
  if (found == rows_.end()) found = rows_.insert(rows_.end(), {row, {}});
  found->second[trial] = std::move(values);
}

report::Table Trials::EmptyTable(const std::string& title) const {
  report::Table table{title, columns_};
  table.decimals = 3;
  return table;
}

std::vector<double> Trials::OverTrials(const Row& row, Figure figure) const {
  std::vector<double> figures;
  for (size_t c = 0; c < columns_.size(); ++c) {
    std::vector<double> values;
    for (const auto& [trial, of_trial] : row) values.push_back(of_trial[c]);
    figures.push_back(figure(values));
  }
  return figures;
}

report::Table Trials::Means(const std::string& title) const {
  report::Table table = EmptyTable(title);
  table.best = report::Best::kHighest;
  for (const auto& [name, row] : rows_) table.rows.push_back({name, OverTrials(row, Mean)});
  return table;
}

report::Table Trials::Deviations(const std::string& title) const {
  report::Table table = EmptyTable(title);
  for (const auto& [name, row] : rows_) table.rows.push_back({name, OverTrials(row, Deviation)});
  return table;
}

report::Table Trials::Gains(const std::string& title, const std::string& base) const {
  report::Table table = EmptyTable(title);
  const auto found = Find(rows_, base);
  for (auto row = rows_.begin(); found != rows_.end() && row != rows_.end(); ++row) {
    if (row == found) continue;
    Row gains;
    for (const auto& [trial, values] : row->second) {
      const auto before = found->second.find(trial);
      if (before == found->second.end()) continue;
      for (size_t c = 0; c < values.size(); ++c) {
        gains[trial].push_back(values[c] - before->second[c]);
      }
    }
    table.rows.push_back({row->first, OverTrials(gains, Mean)});
    table.rows.push_back({row->first + ", deviation", OverTrials(gains, Deviation)});
    table.rows.push_back({row->first + ", share above 0", OverTrials(gains, ShareAboveZero)});
  }
  return table;
}

absl::StatusOr<std::vector<double>> ClassifierAccuracy(
    const dataset::Dataset& dataset, const TrainingMaterial& material, const std::vector<int>& test,
    const judge::MotionClassifierOptions& options) {
  // Synthetic pairs have their own leaders: they are added to the data set like captured ones.
  dataset::Dataset all = dataset;
  std::vector<int> train = material.captured;
  for (const dataset::Sequence& sequence : material.synthetic) {
    train.push_back(static_cast<int>(all.sequences.size()));
    all.sequences.push_back(sequence);
  }
  DUET_TRY(judge::MotionClassifier classifier,
           judge::MotionClassifier::Train(all, metrics::CapturedMotions(all, train), options));
  metrics::Confusion confusion(dataset.class_count());
  confusion.AddLikeliest(metrics::ClassesOf(dataset, test),
                         classifier.Probabilities(all, metrics::CapturedMotions(all, test)));
  std::vector<double> accuracy = confusion.ClassAccuracies();
  accuracy.push_back(confusion.MeanClassAccuracy());
  return accuracy;
}

absl::Status RunHalf(const dataset::Dataset& dataset, const DataHalf& half,
                     const HalfOptions& options, std::ostream* progress, Trials* trials) {
  for (int repeat = 1; repeat <= options.repeats; ++repeat) {
    for (const Condition& condition : Conditions(half, options)) {
      judge::MotionClassifierOptions classifier;
      classifier.epochs = condition.epochs;
      classifier.seed = static_cast<uint64_t>(repeat);
      DUET_TRY(std::vector<double> accuracy,
               ClassifierAccuracy(dataset, condition.material, half.split.test, classifier));
      *progress << "half " << half.seed << ", classifier " << repeat << ", " << condition.row
                << ": " << accuracy.back() << std::endl;
      trials->Add(condition.row, absl::StrCat(half.seed, "/", repeat), std::move(accuracy));
    }
  }
  return absl::OkStatus();
}

}  // namespace duet::evaluation::experiments
