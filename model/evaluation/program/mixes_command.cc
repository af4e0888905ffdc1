#include <algorithm>
#include <cstddef>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/body/grade.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/measures.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;

// Values of --measures.
constexpr char kMixes[] = "mixes", kReaction[] = "reaction";

struct MixesFlags : ExperimentFlags {
  std::vector<std::string> measures = {kMixes, kReaction};
  std::vector<std::string> reaction_classes;  // empty: all
  int leaders = 0;                            // of each class in a fold; 0: all

  bool Measures(const std::string& name) const {
    return std::count(measures.begin(), measures.end(), name) > 0;
  }
};

// What mixes of a data set are measured with. Shapes: [folds].
struct Meters {
  MeetingGeometry geometry;
  std::vector<ClassGeometry> classes = {};  // of the training captures
  std::vector<judge::MotionClassifier> judges = {};
};

absl::StatusOr<Meters> OpenMeters(const Experiment& experiment, const MixesFlags& flags) {
  const dataset::Dataset& dataset = experiment.dataset;
  Meters meters{MeetingGeometry(dataset.skeleton)};
  if (!meters.geometry.possible() ||
      !body::PairMeter::CanMeasure(dataset.skeleton, meters.geometry.body())) {
    return absl::InvalidArgumentError(
        "--data: expected a skeleton with hips, feet, a chest, a head and two named arms");
  }
  if (!flags.Measures(kMixes)) return meters;
  for (const Fold& fold : experiment.folds) {
    meters.classes.push_back(MeasureClasses(meters.geometry, dataset, fold.split.train));
  }
  DUET_TRY(meters.judges, TrainJudges(dataset, experiment.folds));
  return meters;
}

body::Grade GradeOf(const dataset::Dataset& dataset, const body::Body& body,
                    const motion::Clip& leader, const Poses& follower) {
  body::PairMeter meter(dataset.skeleton, body, leader.frame_rate_hz);
  body::GradeSum sum;
  for (int t = 0; t < follower.frame_count(); ++t) sum.Add(meter.Add(leader.poses[t], follower[t]));
  return sum.Get();
}

// Answers a leader in its own class, in another one, and in two mixes of both.
absl::Status MixWith(const dataset::Dataset& dataset, const Meters& meters, int fold,
                     const engine::Synthesizer& model, const Asked& asked, int leader, int other,
                     int sample, std::vector<MixVariant>* variants) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(leader)];
  const int own = sequence.interaction_class;
  std::vector<LabelledLeader> leaders;
  for (const auto& [own_weight, other_weight] :
       {std::pair(1.0f, 0.0f), {0.5f, 0.5f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
    std::vector<float> weights(dataset.classes.size());
    weights[static_cast<size_t>(own)] = own_weight;
    weights[static_cast<size_t>(other)] = other_weight;
    leaders.push_back({&sequence, std::move(weights), SeedOf(asked, dataset, leader, sample)});
  }
  DUET_TRY(const std::vector<Poses> answers, SynthesizeSequences(model, leaders, asked));
  std::vector<metrics::ScoredMotion> motions;
  for (const Poses& answer : answers) motions.push_back({leader, answer});
  const auto judged = meters.judges[static_cast<size_t>(fold)].Judge(dataset, motions);
  for (size_t v = 0; v < variants->size(); ++v) {
    MixedAnswer answer{leader, fold, own, other};
    answer.mixed = meters.geometry.Measure(sequence, answers[v]);
    answer.own_alone = meters.geometry.Measure(sequence, answers.front());
    answer.other_alone = meters.geometry.Measure(sequence, answers.back());
    answer.probabilities = judged.probabilities[v];
    answer.deviation = Deviation(answers[v], answers.front(), answers.back());
    const body::Grade grade =
        GradeOf(dataset, meters.geometry.body(), sequence.pair.leader, answers[v]);
    answer.twisted = grade.twisted;
    answer.overlapping = grade.overlapping;
    answer.skating = grade.skating;
    (*variants)[v].second.push_back(std::move(answer));
  }
  return absl::OkStatus();
}

// At most `most` (0: all) sequences of each class, evenly spread over those of a fold.
std::vector<int> ChooseLeaders(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                               int most) {
  std::map<int, std::vector<int>> by_class;
  for (const int index : sequences) {
    by_class[dataset.sequences[static_cast<size_t>(index)].interaction_class].push_back(index);
  }
  std::vector<int> chosen;
  for (const auto& [c, of_class] : by_class) {
    const size_t count =
        most == 0 ? of_class.size() : std::min(of_class.size(), static_cast<size_t>(most));
    for (size_t i = 0; i < count; ++i) chosen.push_back(of_class[i * of_class.size() / count]);
  }
  return chosen;
}

// The tables of one model with one start.
absl::Status AddTables(const Experiment& experiment, const MixesFlags& flags, const Meters& meters,
                       const FoldModel& model, const Asked& asked, report::Section* section) {
  const dataset::Dataset& dataset = experiment.dataset;
  const std::string name = model.name + StartSuffix(asked.start);
  std::vector<MixVariant> variants = {{"one label", {}}, {"0.5 / 0.5", {}}, {"1 / 1", {}}};
  std::vector<ReactionPair> reactions;
  for (size_t f = 0; f < experiment.folds.size(); ++f) {
    const Fold& fold = experiment.folds[f];
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, asked.start));
    const std::vector<int> leaders = ChooseLeaders(dataset, fold.split.test, flags.leaders);
    const int samples = synthesizer->description().samples ? asked.samples : 1;
    for (const int leader : flags.Measures(kMixes) ? leaders : std::vector<int>()) {
      const int own = dataset.sequences[static_cast<size_t>(leader)].interaction_class;
      for (int n = 0; n < samples; ++n) {
        for (int other = 0; other < dataset.class_count(); ++other) {
          if (other == own) continue;
          DUET_RETURN_IF_ERROR(MixWith(dataset, meters, static_cast<int>(f), *synthesizer, asked,
                                       leader, other, n, &variants));
        }
      }
    }
    std::vector<int> reacting;
    for (const int leader : flags.Measures(kReaction) ? leaders : std::vector<int>()) {
      const auto& some = flags.reaction_classes;
      const int c = dataset.sequences[static_cast<size_t>(leader)].interaction_class;
      const bool asked_for =
          std::count(some.begin(), some.end(), dataset.classes[static_cast<size_t>(c)]) > 0;
      if (some.empty() || asked_for) reacting.push_back(leader);
    }
    DUET_TRY(const auto answers, AnswerWithSamples(*synthesizer, dataset, reacting, asked));
    for (const metrics::ScoredMotion& answer : Pool(answers)) {
      const dataset::Sequence& sequence = SequenceOf(dataset, answer);
      reactions.push_back(
          {answer.sequence, sequence.interaction_class,
           MeasureReaction(dataset.skeleton, sequence, sequence.pair.follower.poses),
           MeasureReaction(dataset.skeleton, sequence, answer.follower)});
    }
    std::cerr << absl::StrCat(name, " without ", fold.subject, ": ", leaders.size(), " leaders\n");
  }
  if (flags.Measures(kMixes)) {
    section->tables.push_back(MixTable(name + ": mixes", meters.classes, variants));
  }
  if (flags.Measures(kReaction)) {
    section->tables.push_back(ReactionTable(name + ": reaction", reactions));
  }
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunMixes(const MixesFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const Meters meters, OpenMeters(experiment, flags));
  report::Section section = BeginExperiment(
      flags, experiment,
      "The leaders of every left-out subject, answered in mixes of their own class with each other "
      "class, and in their own class. All answers to one leader have one seed; every leader has "
      "its "
      "own. +pose: the input includes the follower's first pose.");
  for (const std::string& start : flags.starts) {
    for (const FoldModel& model : experiment.models) {
      Asked asked = flags.asked;
      asked.start = start;
      DUET_RETURN_IF_ERROR(AddTables(experiment, flags, meters, model, asked, &section));
    }
  }
  return section;
}

}  // namespace

Measure AddMixesCommand(CLI::App* command) {
  const auto flags = std::make_shared<MixesFlags>();
  AddAnswersFlags(flags.get(), command);
  AddNumber("--leaders", &flags->leaders, 0, 1000,
            "leaders of each class in a fold; 0: all of the left-out subject", command);
  AddNames("--measures", &flags->measures, {kMixes, kReaction}, "what to measure", command);
  command
      ->add_option("--reaction-classes", flags->reaction_classes,
                   "classes of the reaction (default: all)")
      ->delimiter(',');
  return [flags] { return RunMixes(*flags); };
}

}  // namespace duet::evaluation::program
