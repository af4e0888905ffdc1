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
#include "model/body/posture.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/measures.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;

struct MixesFlags : ExperimentFlags {
  std::vector<std::string> reaction_classes;  // empty: all
  int leaders = 0;                            // of each class in a fold; 0: all
};

// What judges mixes of a data set. Shapes: [folds].
struct Meters {
  std::vector<ClassGeometry> classes;  // of the training captures
  std::vector<judge::MotionClassifier> judges;
};

absl::StatusOr<Meters> OpenMeters(const Experiment& experiment) {
  const dataset::Dataset& dataset = experiment.dataset;
  if (!CanMeasureMeeting(dataset.skeleton) ||
      !body::PairMeter::CanMeasure(dataset.skeleton, body::FindBody(dataset.skeleton))) {
    return absl::InvalidArgumentError(
        "--data: expected a skeleton with hips, feet, a chest, a head and two named arms");
  }
  Meters meters;
  for (const Fold& fold : experiment.folds) {
    meters.classes.push_back(MeasureClasses(dataset, fold.split.train));
  }
  DUET_TRY(meters.judges, TrainJudges(dataset, experiment.folds));
  return meters;
}

body::Grade GradeOf(const motion::Skeleton& skeleton, const motion::Clip& leader,
                    const Poses& follower) {
  const body::Body body = body::FindBody(skeleton);
  body::PairMeter meter(skeleton, body, leader.frame_rate_hz);
  body::GradeSum sum;
  for (int t = 0; t < follower.frame_count(); ++t) sum.Add(meter.Add(leader.poses[t], follower[t]));
  return sum.Get();
}

struct Measured {
  std::vector<MixVariant> mixes = {{"one label", {}}, {"0.5 / 0.5", {}}, {"1 / 1", {}}};
  std::vector<AvoidingAnswer> avoiding;
  std::vector<ReactionPair> reactions;
};

// Answers a leader in its own class, in another one, in two mixes of both, and in its own class
// with the other one at -1.
absl::Status MixWith(const dataset::Dataset& dataset, const Meters& meters, int fold,
                     const engine::Synthesizer& model, const Asked& asked, int leader, int other,
                     int sample, Measured* measured) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(leader)];
  const int own = sequence.interaction_class;
  std::vector<LabelledLeader> leaders;
  for (const auto& [own_weight, other_weight] :
       {std::pair(1.0f, 0.0f), {0.5f, 0.5f}, {1.0f, 1.0f}, {0.0f, 1.0f}, {1.0f, -1.0f}}) {
    std::vector<float> weights(dataset.classes.size());
    weights[static_cast<size_t>(own)] = own_weight;
    weights[static_cast<size_t>(other)] = other_weight;
    leaders.push_back({&sequence, std::move(weights), SeedOf(asked, dataset, leader, sample)});
  }
  DUET_TRY(const std::vector<Poses> answers, SynthesizeSequences(model, leaders, asked));
  std::vector<metrics::ScoredMotion> motions;
  for (const Poses& answer : answers) motions.push_back({leader, answer});
  const auto judged = meters.judges[static_cast<size_t>(fold)].Judge(dataset, motions);
  const Poses &own_alone = answers[0], &other_alone = answers[3], &avoiding = answers[4];
  for (size_t v = 0; v < measured->mixes.size(); ++v) {
    MixedAnswer answer{leader, fold, own, other};
    answer.mixed = MeasureMeeting(dataset.skeleton, sequence, answers[v]);
    answer.own_alone = MeasureMeeting(dataset.skeleton, sequence, own_alone);
    answer.other_alone = MeasureMeeting(dataset.skeleton, sequence, other_alone);
    answer.probabilities = judged.probabilities[v];
    answer.deviation = Deviation(answers[v], own_alone, other_alone);
    answer.grade = GradeOf(dataset.skeleton, sequence.pair.leader, answers[v]);
    measured->mixes[v].second.push_back(std::move(answer));
  }
  const auto distance = [&](const Poses& follower) {
    return body::RootDistance(sequence.pair.leader.poses, follower, dataset.skeleton);
  };
  measured->avoiding.push_back({leader, own, other, judged.probabilities[0],
                                judged.probabilities[4], distance(avoiding) - distance(own_alone)});
  return absl::OkStatus();
}

// Answers leaders in their own classes, as captured and padded.
absl::Status React(const dataset::Dataset& dataset, const engine::Synthesizer& model,
                   const Asked& asked, const std::vector<int>& leaders, int sample,
                   std::vector<ReactionPair>* reactions) {
  std::vector<dataset::Sequence> sequences;  // each as captured, then padded
  std::vector<int> padding;
  for (const int leader : leaders) {
    const dataset::Sequence& captured = dataset.sequences[static_cast<size_t>(leader)];
    sequences.insert(sequences.end(), 2, captured);
    padding.push_back(PadSequence(&sequences.back()));
  }
  std::vector<LabelledLeader> labelled;
  for (size_t i = 0; i < sequences.size(); ++i) {
    labelled.push_back({&sequences[i],
                        OneClass(dataset.class_count(), sequences[i].interaction_class),
                        SeedOf(asked, dataset, leaders[i / 2], sample)});
  }
  DUET_TRY(const std::vector<Poses> answers, SynthesizeSequences(model, labelled, asked));
  for (size_t i = 0; i < leaders.size(); ++i) {
    const dataset::Sequence& sequence = sequences[2 * i];
    const auto measure = [&](const Poses& follower) {
      return MeasureReaction(dataset.skeleton, sequence, follower);
    };
    Poses padded = answers[2 * i + 1];
    padded.DropFront(padding[i]);
    padded.Resize(sequence.pair.leader.frame_count());
    reactions->push_back({leaders[i], sequence.interaction_class,
                          measure(sequence.pair.follower.poses), measure(answers[2 * i]),
                          measure(padded)});
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
                       const FoldModel& model, report::Section* section) {
  const dataset::Dataset& dataset = experiment.dataset;
  const std::string& name = model.name;
  const Asked& asked = model.asked;
  Measured measured;
  std::vector<bool> contact;  // of each class
  for (size_t f = 0; f < experiment.folds.size(); ++f) {
    const Fold& fold = experiment.folds[f];
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, asked.start));
    const std::vector<int> leaders = ChooseLeaders(dataset, fold.split.test, flags.leaders);
    const int samples = synthesizer->description().samples ? asked.samples : 1;
    contact.clear();
    for (int c = 0; c < dataset.class_count(); ++c) {
      contact.push_back(synthesizer->description().IsContact(c));
    }
    std::vector<int> reacting;
    for (const int leader : leaders) {
      const std::string& of_leader =
          dataset.classes[static_cast<size_t>(metrics::ClassesOf(dataset, {leader})[0])];
      const auto& some = flags.reaction_classes;
      if (some.empty() || std::count(some.begin(), some.end(), of_leader) > 0) {
        reacting.push_back(leader);
      }
    }
    for (int n = 0; n < samples; ++n) {
      for (const int leader : leaders) {
        const int own = dataset.sequences[static_cast<size_t>(leader)].interaction_class;
        for (int other = 0; other < dataset.class_count(); ++other) {
          if (other == own) continue;
          DUET_RETURN_IF_ERROR(MixWith(dataset, meters, static_cast<int>(f), *synthesizer, asked,
                                       leader, other, n, &measured));
        }
      }
      DUET_RETURN_IF_ERROR(React(dataset, *synthesizer, asked, reacting, n, &measured.reactions));
    }
    std::cerr << absl::StrCat(name, " without ", fold.subject, ": ", leaders.size(), " leaders\n");
  }
  std::vector<MixVariant> two_kinds = measured.mixes;
  for (auto& [variant, answers] : two_kinds) {
    const auto one_kind = [&](const MixedAnswer& answer) {
      return contact[static_cast<size_t>(answer.own)] == contact[static_cast<size_t>(answer.other)];
    };
    answers.erase(std::remove_if(answers.begin(), answers.end(), one_kind), answers.end());
  }
  section->tables.insert(
      section->tables.end(),
      {MixTable(name + ": mixes", meters.classes, measured.mixes),
       MixTable(name + ": mixes of contact with other classes", meters.classes, two_kinds),
       AvoidTable(name + ": negatives", measured.avoiding),
       ReactionTable(name + ": reaction", measured.reactions)});
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunMixes(const MixesFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const Meters meters, OpenMeters(experiment));
  report::Section section = BeginExperiment(
      flags, experiment,
      "The leaders of every left-out subject, answered in mixes of their own class with each other "
      "class, with each other class at -1, and in their own class with the leader held still "
      "before and after the clip. All answers to one leader have one seed; every leader has its "
      "own. +pose: the input includes the follower's first pose.");
  for (const FoldModel& model : experiment.models) {
    DUET_RETURN_IF_ERROR(AddTables(experiment, flags, meters, model, &section));
  }
  return section;
}

}  // namespace

Measure AddMixesCommand(CLI::App* command) {
  const auto flags = std::make_shared<MixesFlags>();
  AddAnswersFlags(flags.get(), command);
  AddNumber("--leaders", &flags->leaders, 0, 1000,
            "leaders of each class in a fold; 0: all of the left-out subject", command);
  command
      ->add_option("--reaction-classes", flags->reaction_classes,
                   "classes of the reaction (default: all)")
      ->delimiter(',');
  return [flags] { return RunMixes(*flags); };
}

}  // namespace duet::evaluation::program
