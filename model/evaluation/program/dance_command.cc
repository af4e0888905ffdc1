#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/evaluation/baselines/take_baselines.h"
#include "model/evaluation/metrics/dance.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/penetration.h"
#include "model/evaluation/metrics/posture.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/report/result_section.h"
#include "model/motion/filter.h"
#include "model/motion/standardise.h"
#include "model/motion/steps.h"

namespace duet::evaluation::program {
namespace {

// Figures of one follower of one take, in the order of Columns().
using Figures = std::vector<double>;

std::vector<std::string> Columns() {
  return {"error",   "distance", "facing",    "turns", "matched", "delay", "held",
          "hold, s", "slip",     "both feet", "steps", "speed",   "lean",  "overlap"};
}

// A row of the table: a way to answer takes, and its followers of all takes.
struct Row {
  std::string name;
  std::vector<Figures> takes;
};

struct Take {
  const dataset::Sequence* sequence;
  const Fold* fold;
};

std::vector<Take> TakesOf(const Experiment& experiment) {
  std::vector<Take> takes;
  for (const Fold& fold : experiment.folds) {
    for (const int index : fold.split.test) {
      takes.push_back({&experiment.dataset.sequences[static_cast<size_t>(index)], &fold});
    }
  }
  return takes;
}

Figures Measure(const dataset::Dataset& dataset, const metrics::DanceJoints& joints,
                const dataset::Sequence& take, const motion::Poses& follower) {
  const motion::Poses& leader = take.pair.leader.poses;
  const motion::Poses& captured = take.pair.follower.poses;
  const double rate = dataset.frame_rate_hz;
  const auto turns = [&](const motion::Poses& person) {
    return metrics::FindTurns(joints, person, leader, rate);
  };
  const std::vector<metrics::Turn> made = turns(follower), original = turns(captured);
  const metrics::TurnMatch match = metrics::MatchTurns(original, made);
  const metrics::Holds holds = metrics::MeasureHolds(joints, leader, follower, rate);
  return {
      metrics::MeanError(follower, captured),
      metrics::RootDistance(leader, follower, dataset.skeleton),
      metrics::FacingDegrees(leader, follower, dataset.skeleton),
      static_cast<double>(made.size()),
      original.empty() ? NAN : match.matched / static_cast<double>(original.size()),
      match.mean_delay,
      holds.share,
      holds.mean_seconds,
      holds.slip,
      metrics::BothFeetMove(joints, follower, rate),
      motion::MeasureStepTiming(motion::FindSteps(joints.feet, follower, rate),
                                motion::FindSteps(joints.feet, leader, rate))
          .spread,
      metrics::JointSpeed(motion::WithoutNoise(follower, rate), rate),
      metrics::MeasureLean(follower, dataset.skeleton, rate, metrics::LeanFrom::kHips).max_degrees,
      metrics::MeasurePenetration(leader, follower, dataset.skeleton, dataset.parts).frequency};
}

// A follower of another leader, moved as if that leader began where this one does, and cut or held
// to this one's length.
motion::Poses MovedTo(const motion::Skeleton& skeleton, const dataset::Sequence& take,
                      const motion::Poses& leader, const motion::Poses& follower) {
  const auto frame = [&](const motion::Poses& of) {
    return motion::Standardisation(skeleton, of, motion::YawDirection::kRemove,
                                   motion::StandardOrigin::kFirstFrame);
  };
  const motion::Poses standard = frame(leader).Apply(follower);
  motion::Poses cut(0, standard.joint_count());
  for (int t = 0; t < take.pair.leader.frame_count(); ++t) {
    cut.Append(standard[std::min(t, standard.frame_count() - 1)]);
  }
  return frame(take.pair.leader.poses).Invert(cut);
}

// The model's answers to all takes: [takes].
absl::StatusOr<std::vector<motion::Poses>> AnswerTakes(const Experiment& experiment,
                                                       const FoldModel& model,
                                                       const std::vector<Take>& takes,
                                                       experiments::StartGiven start,
                                                       const engine::Sampling& sampling) {
  std::vector<motion::Poses> followers;
  for (const Take& take : takes) {
    absl::StatusOr<SharedSynthesizer> synthesizer = model.load(take.fold->subject);
    if (!synthesizer.ok()) return synthesizer.status();
    absl::Status fits = CheckModelTakes((*synthesizer)->description(), experiment.dataset, start);
    if (!fits.ok()) return fits;
    const experiments::LabelledLeader leader = {
        take.sequence,
        experiments::TimeLineLabels(*take.sequence, experiment.dataset.class_count()), sampling};
    absl::StatusOr<std::vector<motion::Poses>> answer =
        SynthesizeSequences(**synthesizer, {&leader, 1}, start);
    if (!answer.ok()) return answer.status();
    followers.push_back(std::move(answer->front()));
  }
  return followers;
}

// Rows of one model with one kind of start: its answers with each seed, and the same answers beside
// the leader of the next take.
absl::Status AddModel(const Experiment& experiment, const metrics::DanceJoints& joints,
                      const FoldModel& model, const ExperimentFlags& flags,
                      const std::string& start, std::vector<Row>* rows) {
  const std::vector<Take> takes = TakesOf(experiment);
  const std::string name = absl::StrCat(model.name, StartSuffix(ParseStart(start)));
  Row own = {name, {}}, chance = {absl::StrCat(name, ", other lead"), {}};
  for (int n = 0; n < flags.asked.samples; ++n) {
    absl::StatusOr<std::vector<motion::Poses>> followers =
        AnswerTakes(experiment, model, takes, ParseStart(start),
                    {flags.asked.seed + static_cast<uint64_t>(n), flags.asked.variety});
    if (!followers.ok()) return followers.status();
    for (size_t i = 0; i < takes.size(); ++i) {
      const dataset::Sequence& take = *takes[i].sequence;
      own.takes.push_back(Measure(experiment.dataset, joints, take, (*followers)[i]));
      const size_t other = (i + 1) % takes.size();
      if (other == i) continue;
      chance.takes.push_back(
          Measure(experiment.dataset, joints, take,
                  MovedTo(experiment.dataset.skeleton, take,
                          takes[other].sequence->pair.leader.poses, (*followers)[other])));
    }
    std::cerr << name << ": seed " << n + 1 << " of " << flags.asked.samples << "\n";
  }
  rows->push_back(std::move(own));
  if (!chance.takes.empty()) rows->push_back(std::move(chance));
  return absl::OkStatus();
}

void AddBaselines(const Experiment& experiment, const metrics::DanceJoints& joints,
                  std::vector<Row>* rows) {
  const dataset::Dataset& dataset = experiment.dataset;
  Row held = {"first pose held", {}}, mean = {"class mean", {}}, nearest = {"nearest seconds", {}},
      captured = {"captured", {}};
  for (const Take& take : TakesOf(experiment)) {
    const std::vector<int>& train = take.fold->split.train;
    const auto add = [&](const motion::Poses& follower, Row* row) {
      row->takes.push_back(Measure(dataset, joints, *take.sequence, follower));
    };
    add(baselines::FirstPoseHeld(*take.sequence), &held);
    add(baselines::MeanOfClass(dataset, train, *take.sequence), &mean);
    add(baselines::NearestSeconds(dataset, train, *take.sequence), &nearest);
    add(take.sequence->pair.follower.poses, &captured);
  }
  for (Row* row : {&held, &mean, &nearest, &captured}) rows->push_back(std::move(*row));
}

// Means over the takes.
report::Table ToTable(const std::vector<Row>& rows) {
  report::Table table;
  table.title = "Followers of whole takes, mean over the takes";
  table.columns = Columns();
  for (const Row& row : rows) {
    std::vector<double> means;
    for (size_t c = 0; c < table.columns.size(); ++c) {
      std::vector<double> values;
      for (const Figures& take : row.takes) values.push_back(take[c]);
      means.push_back(base::Mean(values));
    }
    table.rows.push_back({row.name, std::move(means)});
  }
  table.notes = {
      "Error: mean distance of a joint from the captured one, metres. Distance: of the roots, "
      "metres. Facing: angle between the follower's facing direction and the leader, degrees.",
      "Turns: rotations against the line between the people of at least 230 degrees. Matched: "
      "share "
      "of the captured turns with one the same way within 1.5 s. Delay: mean time between the "
      "middles of matched turns, seconds.",
      "Held: share of frames in which a wrist of one is less than 28 cm from a wrist of the other; "
      "hold: mean length of a hold, seconds; slip: speed of the two wrists against each other "
      "while "
      "held, m/s.",
      "Both feet: share of frames in which both are faster than 0.15 m/s. Steps: standard "
      "deviation "
      "of the time from a step to the leader's nearest one, seconds. Speed: of the joints without "
      "noise, m/s. Lean: largest mean over one second of hips to neck, degrees. Overlap: share of "
      "frames in which the bodies overlap."};
  table.decimals = 3;
  return table;
}

absl::Status Run(const ExperimentFlags& flags) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(flags);
  if (!experiment.ok()) return experiment.status();
  absl::StatusOr<metrics::DanceJoints> joints =
      metrics::FindDanceJoints(experiment->dataset.skeleton);
  if (!joints.ok()) return joints.status();
  std::vector<Row> rows;
  AddBaselines(*experiment, *joints, &rows);
  for (const FoldModel& model : experiment->models) {
    for (const std::string& start : flags.starts) {
      absl::Status status = AddModel(*experiment, *joints, model, flags, start, &rows);
      if (!status.ok()) return status;
    }
  }
  report::ResultSection section = BeginExperiment(
      flags, *experiment,
      "Whole takes of left-out subjects, answered with the labels of their time lines. \"Other "
      "lead\": the same answers beside the leader of the next take, as if both leaders began at "
      "the "
      "same place; a figure that is as good there does not depend on the leader.");
  section.settings.emplace_back("seeds", absl::StrCat(flags.asked.samples));
  section.settings.emplace_back("variety", absl::StrCat(flags.asked.variety));
  section.tables = {ToTable(rows)};
  return FinishSection(flags.section, section);
}

}  // namespace

void AddDanceCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto flags = std::make_shared<ExperimentFlags>();
  flags->starts = {"pose"};
  flags->asked.samples = 3;
  CLI::App* command = app->add_subcommand("dance", "Followers of whole takes of a couple's dance");
  AddAnswersFlags("18_dance", "Whole takes of a dance", flags.get(), command);
  command->add_option("--samples", flags->asked.samples, "answers to each take, each with its seed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  RunWhenNamed(command, flags, Run, chosen);
}

}  // namespace duet::evaluation::program
