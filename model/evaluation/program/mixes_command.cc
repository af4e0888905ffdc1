#include <algorithm>
#include <cstddef>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/body/grade.h"
#include "model/body/posture.h"
#include "model/evaluation/experiments/mixes.h"
#include "model/evaluation/experiments/reaction.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_scorer.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;

// Values of --measures.
constexpr char kMixes[] = "mixes", kSteps[] = "steps", kNegatives[] = "negatives",
               kReaction[] = "reaction";
// A weight moves from 0 to 1 in so many steps if the largest move is measured.
constexpr int kWeightSteps = 10;

struct MixesArguments : ExperimentFlags {
  std::vector<std::string> measures = {kMixes, kSteps, kNegatives, kReaction};
  std::vector<std::string> reaction_classes;  // empty: all
  int leaders = 0;                            // of each class in a fold; 0: all

  bool Measures(const std::string& name) const {
    return std::count(measures.begin(), measures.end(), name) > 0;
  }
};

// What the measures of a data set need.
struct Meters {
  explicit Meters(const motion::Skeleton& skeleton) : geometry(skeleton), reaction(skeleton) {}

  experiments::MeetingGeometry geometry;
  experiments::ReactionMeter reaction;
  // [folds]: of the training captures.
  std::vector<experiments::ClassGeometry> classes;
  std::vector<judge::MotionClassifier> judges;
};

// The answers of all folds' leaders by one model with one start.
struct Measured {
  std::vector<experiments::MixVariant> mixes = {
      {"one label", {}}, {"0.5 / 0.5", {}}, {"1 / 1", {}}};
  std::vector<experiments::AvoidingAnswer> avoiding;
  std::vector<experiments::ReactionPair> reactions;
};

// One fold's leaders, answered by its model.
class FoldMeasurement {
 public:
  // Everything must outlive it. `start`: what the requests tell.
  FoldMeasurement(const MixesArguments& arguments, const dataset::Dataset& dataset,
                  const Meters& meters, int fold, const engine::Synthesizer& model,
                  experiments::StartGiven start, Measured* measured)
      : arguments_(arguments),
        dataset_(dataset),
        meters_(meters),
        fold_(fold),
        model_(model),
        start_(start),
        measured_(measured) {}

  // Measures what the arguments ask for.
  absl::Status Measure(const std::vector<int>& leaders) {
    for (int n = 0; n < (model_.description().samples ? arguments_.asked.samples : 1); ++n) {
      for (const int leader : leaders) {
        if (arguments_.Measures(kMixes)) DUET_RETURN_IF_ERROR(Mix(leader, n));
        if (arguments_.Measures(kNegatives)) DUET_RETURN_IF_ERROR(Avoid(leader, n));
      }
      if (arguments_.Measures(kReaction)) DUET_RETURN_IF_ERROR(React(leaders, n));
    }
    return absl::OkStatus();
  }

 private:
  const dataset::Sequence& SequenceOf(int leader) const {
    return dataset_.sequences[static_cast<size_t>(leader)];
  }
  std::vector<float> Weights(int own, float own_weight, int other, float other_weight) const {
    std::vector<float> weights(dataset_.classes.size());
    weights[static_cast<size_t>(own)] = own_weight;
    weights[static_cast<size_t>(other)] = other_weight;
    return weights;
  }
  std::vector<int> ClassesBeside(int own) const {
    std::vector<int> others;
    for (int c = 0; c < dataset_.class_count(); ++c) {
      if (c != own) others.push_back(c);
    }
    return others;
  }

  // The answers to one leader for several label vectors, with one seed.
  absl::StatusOr<std::vector<Poses>> Answer(int leader, int sample,
                                            const std::vector<std::vector<float>>& labels) const {
    const experiments::AskedSamples& asked = arguments_.asked;
    const uint64_t seed = SeedOf(asked, dataset_, leader, sample);
    std::vector<experiments::LabelledLeader> leaders;
    for (const std::vector<float>& weights : labels) {
      leaders.push_back(Ask(SequenceOf(leader), engine::LabelTrack(weights), asked, seed));
    }
    return SynthesizeSequences(model_, leaders, start_);
  }

  std::vector<std::vector<float>> Judge(int leader, std::vector<Poses> followers) const {
    std::vector<metrics::ScoredMotion> motions;
    for (Poses& follower : followers) motions.push_back({leader, std::move(follower)});
    return meters_.judges[static_cast<size_t>(fold_)].Probabilities(dataset_, motions);
  }

  std::vector<double> Geometry(int leader, const Poses& follower) const {
    const dataset::Sequence& sequence = SequenceOf(leader);
    return meters_.geometry.Measure(sequence.pair.leader.poses, follower,
                                    experiments::AwayFromLeader(sequence, dataset_.skeleton.root),
                                    sequence.pair.leader.frame_rate_hz);
  }

  body::Grade GradeOf(int leader, const Poses& follower) const {
    const motion::Clip& clip = SequenceOf(leader).pair.leader;
    body::PairMeter meter(dataset_.skeleton, meters_.geometry.body(), clip.frame_rate_hz);
    body::GradeSum sum;
    for (int t = 0; t < follower.frame_count(); ++t) sum.Add(meter.Add(clip.poses[t], follower[t]));
    return sum.Get();
  }

  absl::Status Mix(int leader, int sample) {
    for (const int other : ClassesBeside(SequenceOf(leader).interaction_class)) {
      DUET_RETURN_IF_ERROR(MixWith(leader, other, sample));
    }
    return absl::OkStatus();
  }

  // Weights from the own class alone to the other class alone, and from the own class alone to
  // both at 1.
  absl::Status MixWith(int leader, int other, int sample) {
    const int own = SequenceOf(leader).interaction_class;
    const bool all_steps = arguments_.Measures(kSteps);
    const size_t steps = all_steps ? kWeightSteps : 2;
    std::vector<std::vector<float>> labels;
    for (const bool adds : {false, true}) {
      for (size_t i = 0; i <= steps; ++i) {
        const float weight = static_cast<float>(i) / static_cast<float>(steps);
        labels.push_back(Weights(own, adds ? 1 : 1 - weight, other, weight));
      }
    }
    DUET_TRY(const std::vector<Poses> answers, Answer(leader, sample, labels));
    const Poses &own_alone = answers.front(), &other_alone = answers[steps];
    // Shapes: as Measured::mixes.
    const Poses* const mixed[] = {&own_alone, &answers[steps / 2], &answers.back()};
    const auto probabilities = Judge(leader, {*mixed[0], *mixed[1], *mixed[2]});
    const auto largest_move = [&](size_t first) {
      double largest = 0;
      for (size_t i = first; i < first + steps; ++i) {
        largest = std::max(largest, experiments::LargestMove(answers[i], answers[i + 1]));
      }
      return largest;
    };
    for (size_t v = 0; v < measured_->mixes.size(); ++v) {
      experiments::MixedAnswer answer{leader, fold_, own, other};
      answer.mixed = Geometry(leader, *mixed[v]);
      answer.own_alone = Geometry(leader, own_alone);
      answer.other_alone = Geometry(leader, other_alone);
      answer.probabilities = probabilities[v];
      answer.deviation = experiments::Deviation(*mixed[v], own_alone, other_alone);
      const body::Grade grade = GradeOf(leader, *mixed[v]);
      answer.twisted = grade.twisted;
      answer.overlapping = grade.overlapping;
      answer.skating = grade.skating;
      if (all_steps && v > 0) answer.largest_move = largest_move((v - 1) * (steps + 1));
      measured_->mixes[v].second.push_back(std::move(answer));
    }
    return absl::OkStatus();
  }

  absl::Status Avoid(int leader, int sample) {
    const dataset::Sequence& sequence = SequenceOf(leader);
    const int own = sequence.interaction_class;
    const std::vector<int> others = ClassesBeside(own);
    std::vector<std::vector<float>> labels = {experiments::OneClass(dataset_.class_count(), own)};
    for (const int other : others) labels.push_back(Weights(own, 1, other, -1));
    DUET_TRY(const std::vector<Poses> answers, Answer(leader, sample, labels));
    const auto probabilities = Judge(leader, answers);
    const auto distance = [&](const Poses& follower) {
      return body::RootDistance(sequence.pair.leader.poses, follower, dataset_.skeleton);
    };
    for (size_t i = 0; i < others.size(); ++i) {
      measured_->avoiding.push_back({leader, own, others[i], probabilities.front(),
                                     probabilities[i + 1],
                                     distance(answers[i + 1]) - distance(answers.front())});
    }
    return absl::OkStatus();
  }

  // Answers to the leaders in their own classes, as captured and padded.
  absl::Status React(const std::vector<int>& all_leaders, int sample) {
    const experiments::AskedSamples& asked = arguments_.asked;
    std::vector<int> leaders;
    for (const int leader : all_leaders) {
      const auto& some = arguments_.reaction_classes;
      const std::string& name =
          dataset_.classes[static_cast<size_t>(SequenceOf(leader).interaction_class)];
      if (some.empty() || std::count(some.begin(), some.end(), name) > 0) leaders.push_back(leader);
    }
    std::vector<dataset::Sequence> padded;
    std::vector<int> padding;
    for (const int leader : leaders) {
      padded.push_back(SequenceOf(leader));
      padding.push_back(experiments::PadSequence(&padded.back()));
    }
    std::vector<experiments::LabelledLeader> plain_asked, padded_asked;
    for (size_t i = 0; i < leaders.size(); ++i) {
      const dataset::Sequence& sequence = SequenceOf(leaders[i]);
      const engine::LabelTrack labels(
          experiments::OneClass(dataset_.class_count(), sequence.interaction_class));
      const uint64_t seed = SeedOf(asked, dataset_, leaders[i], sample);
      plain_asked.push_back(Ask(sequence, labels, asked, seed));
      padded_asked.push_back(Ask(padded[i], labels, asked, seed));
    }
    DUET_TRY(const auto plain, SynthesizeSequences(model_, plain_asked, start_));
    DUET_TRY(const auto with_padding, SynthesizeSequences(model_, padded_asked, start_));
    for (size_t i = 0; i < leaders.size(); ++i) {
      const dataset::Sequence& sequence = SequenceOf(leaders[i]);
      measured_->reactions.push_back(
          {leaders[i], sequence.interaction_class, meters_.reaction.Captured(sequence),
           meters_.reaction.Measure(sequence, plain[i], 0),
           meters_.reaction.Measure(sequence, with_padding[i], padding[i])});
    }
    return absl::OkStatus();
  }

  const MixesArguments& arguments_;
  const dataset::Dataset& dataset_;
  const Meters& meters_;
  const int fold_;
  const engine::Synthesizer& model_;
  const experiments::StartGiven start_;
  Measured* measured_;
};

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

absl::StatusOr<Meters> OpenMeters(const Experiment& experiment, const MixesArguments& arguments) {
  const dataset::Dataset& dataset = experiment.dataset;
  Meters meters(dataset.skeleton);
  if (!meters.geometry.possible() || !meters.reaction.possible() ||
      !body::PairMeter::CanMeasure(dataset.skeleton, meters.geometry.body())) {
    return absl::InvalidArgumentError(
        "--data: expected a skeleton with hips, feet, a chest, a head and two named arms");
  }
  for (const Fold& fold : experiment.folds) {
    meters.classes.push_back(MeasureClasses(meters.geometry, dataset, fold.split.train));
    if (!arguments.Measures(kMixes) && !arguments.Measures(kNegatives)) continue;
    DUET_TRY(judge::MotionClassifier judge, TrainFoldJudge(dataset, fold));
    meters.judges.push_back(std::move(judge));
  }
  return meters;
}

absl::StatusOr<std::vector<report::Table>> TablesOf(const Experiment& experiment,
                                                    const MixesArguments& arguments,
                                                    const Meters& meters, const FoldModel& model,
                                                    experiments::StartGiven start) {
  const dataset::Dataset& dataset = experiment.dataset;
  const std::string row = model.name + StartSuffix(start);
  Measured measured;
  for (size_t i = 0; i < experiment.folds.size(); ++i) {
    const Fold& fold = experiment.folds[i];
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, start));
    const std::vector<int> leaders = ChooseLeaders(dataset, fold.split.test, arguments.leaders);
    FoldMeasurement of_fold(arguments, dataset, meters, static_cast<int>(i), *synthesizer, start,
                            &measured);
    DUET_RETURN_IF_ERROR(of_fold.Measure(leaders));
    std::cerr << absl::StrCat(row, " without ", fold.subject, ": ", leaders.size(), " leaders\n");
  }
  std::vector<report::Table> tables;
  const auto add = [&tables](std::vector<report::Table> more) {
    for (report::Table& table : more) tables.push_back(std::move(table));
  };
  if (arguments.Measures(kMixes)) {
    add(MixTables(row + ": mixes", dataset.classes, meters.classes, measured.mixes));
  }
  if (arguments.Measures(kNegatives)) {
    tables.push_back(AvoidTable(row + ": negatives", measured.avoiding));
  }
  if (arguments.Measures(kReaction)) {
    add(ReactionTables(row + ": reaction", dataset.classes, measured.reactions));
  }
  return tables;
}

absl::Status RunMixes(const MixesArguments& arguments) {
  DUET_TRY(Experiment experiment, OpenExperiment(arguments));
  DUET_TRY(const Meters meters, OpenMeters(experiment, arguments));
  report::ResultSection section = BeginAnswers(
      arguments, experiment,
      "The leaders of every left-out subject, answered in mixes of their own class with each other "
      "class, with each other class at -1, and in their own class with the leader held still "
      "before and after the clip. All answers to one leader have one seed; every leader has its "
      "own. +pose: the input includes the follower's first pose.");
  section.settings.emplace_back("answers to a leader", absl::StrCat(arguments.asked.samples));
  section.settings.emplace_back(
      "leaders of a class in a fold",
      arguments.leaders == 0 ? "all" : absl::StrCat("at most ", arguments.leaders));
  section.settings.emplace_back(
      "classes of the reaction",
      arguments.reaction_classes.empty() ? "all" : absl::StrJoin(arguments.reaction_classes, ", "));
  for (size_t i = 0; i < meters.judges.size(); ++i) {
    section.settings.push_back(JudgeSetting(experiment.folds[i], meters.judges[i]));
  }
  for (const std::string& start : arguments.starts) {
    for (const FoldModel& model : experiment.models) {
      DUET_TRY(auto tables, TablesOf(experiment, arguments, meters, model, ParseStart(start)));
      for (report::Table& table : tables) section.tables.push_back(std::move(table));
    }
  }
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddMixesCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "mixes", "What mixes and negative labels do, and how followers react", RunMixes, app, chosen);
  arguments->asked.samples = 1;
  AddAnswersFlags("32_mixes", "Mixes, negatives and reaction", arguments, command);
  AddNumber("--samples", &arguments->asked.samples, 1, 1000, "answers to each leader", command);
  AddNumber("--leaders", &arguments->leaders, 0, 1000,
            "leaders of each class in a fold; 0: all of the left-out subject", command);
  AddNames("--measures", &arguments->measures, {kMixes, kSteps, kNegatives, kReaction},
           "what to measure; steps: the largest move for a weight step of 0.1, with mixes",
           command);
  command
      ->add_option("--reaction-classes", arguments->reaction_classes,
                   "classes of the reaction (default: all)")
      ->delimiter(',');
}

}  // namespace duet::evaluation::program
