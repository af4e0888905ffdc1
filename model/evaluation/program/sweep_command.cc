#include <cmath>
#include <cstddef>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/measures.h"

namespace duet::evaluation::program {
namespace {

// Of SweepWeights: -1, 0 and 1.
constexpr size_t kMinusOne = 0, kZero = 4, kOne = 8;
// Changes of the probability up to this count as level: a probability of 0 cannot fall.
constexpr double kLevelChange = 1e-3;

// The raised class's probability at each weight.
std::vector<double> Raised(const SweepCurve& curve) {
  std::vector<double> raised;
  for (const std::vector<float>& of_weight : curve.probabilities) {
    raised.push_back(double{of_weight[static_cast<size_t>(curve.raised)]});
  }
  return raised;
}

// A leader's answers at every weight of every class, own and added: all with one seed, so that only
// the weight differs.
absl::Status SweepLeader(const dataset::Dataset& dataset, const engine::Synthesizer& model,
                         const judge::MotionClassifier& judge, int index, uint64_t seed,
                         const Asked& asked, std::vector<SweepCurve>* curves) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
  const int classes = dataset.class_count(), own = sequence.interaction_class;
  std::vector<LabelledLeader> leaders;
  for (int raised = 0; raised < classes; ++raised) {
    for (const double weight : SweepWeights()) {
      std::vector<float> labels = OneClass(classes, own);
      labels[static_cast<size_t>(raised)] = static_cast<float>(weight);
      leaders.push_back({&sequence, std::move(labels), seed});
    }
  }
  DUET_TRY(std::vector<motion::Poses> followers, SynthesizeSequences(model, leaders, asked));
  std::vector<metrics::ScoredMotion> motions;
  for (motion::Poses& follower : followers) motions.push_back({index, std::move(follower)});
  const metrics::JudgedFold judged = judge.Judge(dataset, motions);
  auto row = judged.probabilities.begin();
  for (int raised = 0; raised < classes; ++raised) {
    const auto end = row + static_cast<std::ptrdiff_t>(SweepWeights().size());
    curves->push_back({own, raised, {row, end}});
    row = end;
  }
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunSweep(const ExperimentFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  const dataset::Dataset& dataset = experiment.dataset;
  DUET_TRY(const auto judges, TrainJudges(dataset, experiment.folds));
  report::Section section = BeginExperiment(
      flags, experiment,
      "Every leader of every fold's left-out subject is answered at each weight from -1 to 2 of "
      "its own class alone, and of each other class beside its own at 1. The fold's judge, trained "
      "without the left-out subject, gives the probability of each class. At weight 0 of its own "
      "class, the network has no label and infers the motion from the leader.");
  for (const FoldModel& model : experiment.models) {
    std::vector<SweepCurve> curves;
    for (size_t f = 0; f < experiment.folds.size(); ++f) {
      const Fold& fold = experiment.folds[f];
      DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
      const engine::ModelDescription& description = synthesizer->description();
      DUET_RETURN_IF_ERROR(CheckModelTakes(description, dataset, model.asked.start));
      // A model that does not sample has the same answer for every seed.
      const int samples = description.samples ? model.asked.samples : 1;
      for (const int index : fold.split.test) {
        for (int n = 0; n < samples; ++n) {
          DUET_RETURN_IF_ERROR(SweepLeader(dataset, *synthesizer, judges[f], index,
                                           model.asked.seed + static_cast<uint64_t>(n), model.asked,
                                           &curves));
        }
      }
      std::cerr << model.name << " without " << fold.subject << ": " << fold.split.test.size()
                << " leaders\n";
    }
    for (report::Table& table : SweepTables(model.name, dataset.classes, curves)) {
      section.tables.push_back(std::move(table));
    }
  }
  return section;
}

}  // namespace

const std::vector<double>& SweepWeights() {
  static const auto& weights =
      *new std::vector<double>{-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2};
  return weights;
}

std::vector<report::Table> SweepTables(const std::string& model,
                                       const std::vector<std::string>& classes,
                                       const std::vector<SweepCurve>& curves) {
  std::vector<report::Table> tables;
  for (const bool own : {true, false}) {
    const std::string title =
        absl::StrCat(model, own ? ": own class alone" : ": another class beside the own one");
    report::Table control{title, {"0 to 1: up", "level", "0 to -1: down", "level"}};
    report::Table probabilities{title + ": probabilities"};
    for (const double weight : SweepWeights()) {
      probabilities.columns.push_back(absl::StrCat(weight));
    }
    std::vector<std::vector<double>> all;
    for (size_t c = 0; c < classes.size(); ++c) {
      std::vector<std::vector<double>> controls, raised;
      for (const SweepCurve& curve : curves) {
        if (curve.raised != static_cast<int>(c) || (curve.own == curve.raised) != own) continue;
        const std::vector<double> p = Raised(curve);
        controls.emplace_back();
        for (const double by : {p[kOne] - p[kZero], p[kZero] - p[kMinusOne]}) {
          controls.back().push_back(by > kLevelChange ? 1 : 0);
          controls.back().push_back(std::abs(by) <= kLevelChange ? 1 : 0);
        }
        raised.push_back(p);
      }
      if (controls.empty()) continue;
      control.rows.push_back({classes[c], report::ColumnMeans(controls)});
      probabilities.rows.push_back({classes[c], report::ColumnMeans(raised)});
      all.insert(all.end(), controls.begin(), controls.end());
    }
    if (!all.empty()) control.rows.push_back({"all", report::ColumnMeans(all)});
    control.notes = {
        "Shares of answers whose probability of the class goes the way its weight goes. Level: by "
        "0.001 or less, either way."};
    probabilities.notes = {"The judges' mean probability of a class, by its weight."};
    tables.insert(tables.end(), {std::move(control), std::move(probabilities)});
  }
  return tables;
}

Measure AddSweepCommand(CLI::App* command) {
  const auto flags = std::make_shared<ExperimentFlags>();
  AddAnswersFlags(flags.get(), command);
  return [flags] { return RunSweep(*flags); };
}

}  // namespace duet::evaluation::program
