#include <algorithm>
#include <array>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/body/dance.h"
#include "model/checkpoint/checkpoint.h"
#include "model/evaluation/baselines/other_people.h"
#include "model/evaluation/experiments/dance.h"
#include "model/evaluation/experiments/looped_leaders.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"
#include "model/evaluation/report/result_section.h"
#include "model/motion/resample.h"
#include "model/motion/standardise.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace duet::evaluation::program {
namespace {

using experiments::DanceRow;

constexpr double kLoopPartSeconds = 60;  // of the answer to a looped take, where a loop begins
constexpr int kPositionSeconds = 5, kPositions = 6;  // of a take, for the error by position
constexpr double kTurnWeights[] = {-1, -0.5, 0, 0.5, 1};
constexpr int kCandidates = 4;  // of the ablation that asks for them

struct DanceFlags : ExperimentFlags {
  double loop_minutes = 0;
  std::string turn_class;
  bool ablations = false;
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

// The figures of a follower of a take.
std::vector<double> Measure(const dataset::Dataset& dataset, const body::DanceJoints& joints,
                            const Take& take, const motion::Poses& follower) {
  const motion::ClipPair& pair = take.sequence->pair;
  return experiments::MeasureDance(dataset, joints, pair.leader.poses, follower,
                                   &pair.follower.poses);
}

// Answers takes with one model and one kind of start.
struct Dancer {
  const Experiment& experiment;
  const body::DanceJoints& joints;
  const FoldModel& model;
  const experiments::AskedSamples& asked;
  experiments::StartGiven start;

  std::string name() const { return absl::StrCat(model.name, StartSuffix(start)); }

  // The answer with the n-th seed.
  absl::StatusOr<motion::Poses> Answer(const Take& take, engine::LabelTrack labels, int n) const {
    DUET_TRY(SharedSynthesizer synthesizer, model.load(take.fold->subject));
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), experiment.dataset, start));
    const experiments::LabelledLeader leader =
        Ask(*take.sequence, std::move(labels), asked, asked.seed + static_cast<uint64_t>(n));
    DUET_TRY(auto answer, SynthesizeSequences(*synthesizer, {&leader, 1}, start));
    return std::move(answer.front());
  }

  // With the labels of the take's time line.
  absl::StatusOr<motion::Poses> Answer(const Take& take, int n) const {
    const int classes = experiment.dataset.class_count();
    return Answer(take, experiments::TimeLineLabels(*take.sequence, classes), n);
  }

  // The answers to all takes with each seed. Shapes: returns [seeds][takes].
  absl::StatusOr<std::vector<std::vector<motion::Poses>>> AnswerAll(
      const std::vector<Take>& takes) const {
    std::vector<std::vector<motion::Poses>> seeds;
    for (int n = 0; n < asked.samples; ++n) {
      seeds.emplace_back();
      for (const Take& take : takes) {
        DUET_TRY(seeds.back().emplace_back(), Answer(take, n));
      }
      std::cerr << name() << ": seed " << n + 1 << " of " << asked.samples << "\n";
    }
    return seeds;
  }
};

// The error of a follower in each position of its take; NaN after its end. Shapes: [kPositions].
std::vector<double> ErrorByPosition(const motion::Poses& follower, const motion::Poses& captured,
                                    double frame_rate_hz) {
  const int length = static_cast<int>(kPositionSeconds * frame_rate_hz);
  std::vector<double> errors(kPositions, std::numeric_limits<double>::quiet_NaN());
  for (int p = 0; p < kPositions && (p + 1) * length <= follower.frame_count(); ++p) {
    errors[static_cast<size_t>(p)] = body::MeanError(motion::Part(follower, p * length, length),
                                                     motion::Part(captured, p * length, length));
  }
  return errors;
}

report::Table PositionTable() {
  report::Table table{"Error by position in the take"};
  for (int p = 0; p < kPositions; ++p) {
    table.columns.push_back(
        absl::StrFormat("%d to %d s", p * kPositionSeconds, (p + 1) * kPositionSeconds));
  }
  table.notes = {"Mean distance of a joint from the captured one, metres."};
  table.decimals = 3;
  return table;
}

// The answers to all takes with each seed, and the same answers beside the leader of the next take.
absl::Status AddAnswers(const Dancer& dancer, std::vector<DanceRow>* rows,
                        report::Table* positions) {
  std::vector<std::vector<double>> errors;
  const dataset::Dataset& dataset = dancer.experiment.dataset;
  const std::vector<Take> takes = TakesOf(dancer.experiment);
  DanceRow own = {dancer.name(), {}}, chance = {absl::StrCat(dancer.name(), ", other lead"), {}};
  DUET_TRY(const auto seeds, dancer.AnswerAll(takes));
  for (const std::vector<motion::Poses>& followers : seeds) {
    for (size_t i = 0; i < takes.size(); ++i) {
      errors.push_back(ErrorByPosition(followers[i], takes[i].sequence->pair.follower.poses,
                                       dataset.frame_rate_hz));
      own.takes.push_back(Measure(dataset, dancer.joints, takes[i], followers[i]));
      const size_t other = (i + 1) % takes.size();
      if (other == i) continue;
      const motion::Poses moved =
          MovedTo(dataset.skeleton, *takes[i].sequence, takes[other].sequence->pair.leader.poses,
                  followers[other]);
      chance.takes.push_back(Measure(dataset, dancer.joints, takes[i], moved));
    }
  }
  positions->rows.push_back({dancer.name(), report::ColumnMeans(errors)});
  rows->push_back(std::move(own));
  if (!chance.takes.empty()) rows->push_back(std::move(chance));
  return absl::OkStatus();
}

// The frames at which the measured minutes of a looped take begin: its start, the second time that
// the take begins, and the last time with a minute left. The leader does the same in all of them.
absl::StatusOr<std::array<int, 3>> LoopParts(const dataset::Dataset& dataset,
                                             const dataset::Sequence& take, double minutes) {
  if (!experiments::IsLoopable(take)) {
    return absl::InvalidArgumentError(
        absl::StrCat("--loop-minutes: expected takes of more than a second, got ", take.id));
  }
  const int loop = experiments::LoopFrames(dataset, take);
  const double rest = (60 * minutes - kLoopPartSeconds) * dataset.frame_rate_hz;
  if (rest < loop) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "--loop-minutes: expected at least %.2f, a minute more than %s lasts, got %g",
        (kLoopPartSeconds + loop / dataset.frame_rate_hz) / 60, take.id, minutes));
  }
  return std::array<int, 3>{0, loop, static_cast<int>(rest) / loop * loop};
}

// Three minutes of each answer to a take whose leader is looped (LoopParts).
absl::Status AddLoops(const Dancer& dancer, double minutes, std::vector<DanceRow>* rows) {
  const dataset::Dataset& dataset = dancer.experiment.dataset;
  DanceRow parts[] = {{absl::StrCat(dancer.name(), ", first minute"), {}},
                      {absl::StrCat(dancer.name(), ", from the second loop"), {}},
                      {absl::StrCat(dancer.name(), ", last minute"), {}}};
  const int length = static_cast<int>(kLoopPartSeconds * dataset.frame_rate_hz);
  for (const Take& take : TakesOf(dancer.experiment)) {
    DUET_TRY(const auto begins, LoopParts(dataset, *take.sequence, minutes));
    const dataset::Sequence looped = experiments::LoopTake(dataset, *take.sequence, 60 * minutes);
    for (int n = 0; n < dancer.asked.samples; ++n) {
      DUET_TRY(motion::Poses follower, dancer.Answer({&looped, take.fold}, n));
      for (size_t part = 0; part < begins.size(); ++part) {
        parts[part].takes.push_back(experiments::MeasureDance(
            dataset, dancer.joints, motion::Part(looped.pair.leader.poses, begins[part], length),
            motion::Part(follower, begins[part], length), nullptr));
      }
    }
  }
  for (DanceRow& part : parts) rows->push_back(std::move(part));
  return absl::OkStatus();
}

report::Table LoopTable(double minutes, const std::vector<DanceRow>& rows) {
  report::Table table = experiments::DanceTable(
      absl::StrFormat("The same leaders looped for %g minutes", minutes), rows);
  table.notes.insert(
      table.notes.begin(),
      "Three minutes of each answer, all from where the leader's take begins: at the start, where "
      "the follower is given; the second time; and the last time with a minute left.");
  return table;
}

// The share of stretches in which the follower turns, by the weight of the turn's class.
absl::Status AddTurns(const Dancer& dancer, int turn_class, report::Table* table) {
  const dataset::Dataset& dataset = dancer.experiment.dataset;
  std::vector<double> led, not_led;
  for (const double weight : kTurnWeights) {
    int stretches[2] = {0, 0}, turned[2] = {0, 0};
    for (const Take& take : TakesOf(dancer.experiment)) {
      const experiments::TurnStretches found =
          experiments::FindTurnStretches(*take.sequence, turn_class, dataset.frame_rate_hz);
      for (const bool is_led : {false, true}) {
        const std::vector<experiments::FrameSpan>& spans = is_led ? found.led : found.not_led;
        for (int n = 0; n < dancer.asked.samples; ++n) {
          DUET_TRY(motion::Poses follower,
                   dancer.Answer(take,
                                 experiments::LabelsWithTurn(*take.sequence, dataset.class_count(),
                                                             turn_class, spans, weight),
                                 n));
          stretches[is_led] += static_cast<int>(spans.size());
          turned[is_led] += experiments::CountTurned(
              spans,
              body::FindTurns(dancer.joints, follower, take.sequence->pair.leader.poses,
                              dataset.frame_rate_hz),
              dataset.frame_rate_hz);
        }
      }
    }
    not_led.push_back(turned[0] / static_cast<double>(stretches[0]));
    led.push_back(turned[1] / static_cast<double>(stretches[1]));
  }
  table->rows.push_back({absl::StrCat(dancer.name(), ", not led"), std::move(not_led)});
  table->rows.push_back({absl::StrCat(dancer.name(), ", led"), std::move(led)});
  return absl::OkStatus();
}

report::Table TurnTable(const std::string& turn_class) {
  report::Table table{absl::StrCat("Turns by the weight of ", turn_class)};
  for (const double weight : kTurnWeights) {
    table.columns.push_back(absl::StrFormat("%g", weight));
  }
  table.notes = {
      "Share of stretches in which the follower turns, if the class has this weight in the stretch "
      "and every other class has 0. Not led: stretches of 4 s without the class in the capture. "
      "Led: the captured ones."};
  table.decimals = 2;
  return table;
}

// A model and how it is asked.
struct Change {
  std::string name;
  engine::ModelDescription model;
  bool clean_up = true;
  experiments::AskedSamples asked;
};

// The noise of training, in the varieties that the checkpoint knows. 1 if it stores all of it.
float VarietyOfTraining(const checkpoint::Manifest& manifest) {
  const auto share = manifest.training.find("flow.noise_share");
  float stored = 1;
  if (share == manifest.training.end() || !absl::SimpleAtof(share->second, &stored)) return 1;
  return stored > 0 ? 1 / stored : 1;
}

// The model of a checkpoint as it is served, then with one change each: without clean-up, with four
// candidates, and with all the noise of its training (if its manifest has flow.noise_share).
// Nothing is trained.
std::vector<Change> Changes(const checkpoint::Manifest& manifest,
                            const experiments::AskedSamples& asked) {
  const Change served = {"as served", manifest.model, true, asked};
  std::vector<Change> changes = {served};
  const auto add = [&](const char* name) -> Change& {
    changes.push_back(served);
    changes.back().name = name;
    return changes.back();
  };
  add("no clean-up").clean_up = false;
  add("four candidates").asked.candidates = kCandidates;
  const float variety = VarietyOfTraining(manifest);
  if (variety != 1) add("all the noise of training").asked.variety *= variety;
  return changes;
}

// The checkpoint as it is served, and without each of its parts: means over the seeds, and their
// deviations.
absl::StatusOr<report::Table> AblationTable(const DanceFlags& flags, const Experiment& experiment,
                                            const body::DanceJoints& joints) {
  DUET_TRY(auto checkpoint, checkpoint::ReadCheckpoint(flags.models.checkpoint));
  report::Table table = experiments::DanceTable("Without parts", {});
  const std::vector<Take> takes = TakesOf(experiment);
  for (Change& change : Changes(checkpoint.manifest, flags.asked)) {
    checkpoint.manifest.model = std::move(change.model);
    DUET_TRY(SharedSynthesizer synthesizer,
             torch_engine::MakeTorchSynthesizer(checkpoint, {true, true, change.clean_up}));
    const FoldModel model = {change.name, [&](const std::string&) { return synthesizer; }};
    const Dancer dancer = {experiment, joints, model, change.asked, experiments::StartGiven::kPose};
    DUET_TRY(const auto seeds, dancer.AnswerAll(takes));
    std::vector<std::vector<double>> means;  // over the takes, [seeds][columns]
    for (const std::vector<motion::Poses>& followers : seeds) {
      std::vector<std::vector<double>> figures;
      for (size_t i = 0; i < takes.size(); ++i) {
        figures.push_back(Measure(experiment.dataset, joints, takes[i], followers[i]));
      }
      means.push_back(report::ColumnMeans(figures));
    }
    report::TableRow mean = {change.name, {}}, deviation = {change.name + ", deviation", {}};
    for (size_t column = 0; column < table.columns.size(); ++column) {
      std::vector<double> values;
      for (const std::vector<double>& seed : means) values.push_back(seed[column]);
      const base::MeanAndDeviation summary = base::Summarise(values);
      mean.values.push_back(summary.mean);
      deviation.values.push_back(summary.deviation);
    }
    table.rows.push_back(std::move(mean));
    table.rows.push_back(std::move(deviation));
  }
  table.notes.push_back("Deviation: over the seeds, of the mean over the takes.");
  return table;
}

void AddBaselines(const Experiment& experiment, const body::DanceJoints& joints,
                  std::vector<DanceRow>* rows) {
  const dataset::Dataset& dataset = experiment.dataset;
  DanceRow held = {"first pose held", {}}, mean = {"class mean", {}},
           nearest = {"nearest seconds", {}}, captured = {"captured", {}};
  for (const Take& take : TakesOf(experiment)) {
    const std::vector<int>& train = take.fold->split.train;
    const dataset::Sequence& sequence = *take.sequence;
    const auto add = [&](const motion::Poses& follower, DanceRow* row) {
      row->takes.push_back(Measure(dataset, joints, take, follower));
    };
    add(baselines::FirstPoseHeld(sequence), &held);
    add(baselines::MeanOfClass(dataset, train, sequence), &mean);
    add(baselines::NearestSeconds(dataset, train, sequence), &nearest);
    add(sequence.pair.follower.poses, &captured);
  }
  for (DanceRow* row : {&held, &mean, &nearest, &captured}) rows->push_back(std::move(*row));
}

// 0 without --turn-class.
absl::StatusOr<int> FindTurnClass(const DanceFlags& flags, const dataset::Dataset& dataset) {
  if (flags.turn_class.empty()) return 0;
  const auto found = std::find(dataset.classes.begin(), dataset.classes.end(), flags.turn_class);
  if (found != dataset.classes.end()) return static_cast<int>(found - dataset.classes.begin());
  return absl::InvalidArgumentError(
      absl::StrCat("--turn-class: expected a class of the data, got ", flags.turn_class));
}

absl::Status RunDance(const DanceFlags& flags) {
  if (flags.ablations && flags.models.checkpoint.empty()) {
    return absl::InvalidArgumentError("--ablations: expected --checkpoint, got none");
  }
  DUET_TRY(Experiment experiment, OpenExperiment(flags));
  DUET_TRY(body::DanceJoints joints, body::FindDanceJoints(experiment.dataset.skeleton));
  DUET_TRY(const int turn_class, FindTurnClass(flags, experiment.dataset));
  std::vector<DanceRow> rows, loops;
  report::Table turns = TurnTable(flags.turn_class), positions = PositionTable();
  AddBaselines(experiment, joints, &rows);
  for (const FoldModel& model : experiment.models) {
    for (const std::string& start : flags.starts) {
      const Dancer dancer = {experiment, joints, model, flags.asked, ParseStart(start)};
      DUET_RETURN_IF_ERROR(AddAnswers(dancer, &rows, &positions));
      if (flags.loop_minutes > 0) {
        DUET_RETURN_IF_ERROR(AddLoops(dancer, flags.loop_minutes, &loops));
      }
      if (!flags.turn_class.empty()) DUET_RETURN_IF_ERROR(AddTurns(dancer, turn_class, &turns));
    }
  }
  report::ResultSection section = BeginExperiment(
      flags, experiment,
      "Whole takes of left-out subjects, answered with the labels of their time lines. \"Other "
      "lead\": the same answers beside the leader of the next take, as if both leaders began at "
      "the same place; a figure that is as good there does not depend on the leader.");
  section.settings.emplace_back("seeds", absl::StrCat(flags.asked.samples));
  section.settings.emplace_back("variety", absl::StrCat(flags.asked.variety));
  section.settings.emplace_back("live", LiveText(flags.asked));
  section.tables = {experiments::DanceTable("Followers of whole takes, mean over the takes", rows)};
  if (!positions.rows.empty()) section.tables.push_back(std::move(positions));
  if (!loops.empty()) section.tables.push_back(LoopTable(flags.loop_minutes, loops));
  if (!turns.rows.empty()) section.tables.push_back(std::move(turns));
  if (flags.ablations) {
    DUET_TRY(section.tables.emplace_back(), AblationTable(flags, experiment, joints));
  }
  return FinishSection(flags.section, section);
}

}  // namespace

void AddDanceCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [flags, command] =
      AddCommand("dance", "Followers of whole takes of a couple's dance", RunDance, app, chosen);
  flags->starts = {"pose"};
  flags->asked.samples = 3;
  AddAnswersFlags("18_dance", "Whole takes of a dance", flags, command);
  AddNumber("--samples", &flags->asked.samples, 1, 1000, "answers to each take, each with its seed",
            command);
  command
      ->add_option(
          "--loop-minutes", flags->loop_minutes,
          "loop the takes, and compare minutes of the answers in which the leader does the same")
      ->check(base::InRange(1.0, 60.0));
  command->add_option("--turn-class", flags->turn_class,
                      "class of a turn: measure how its weight decides that the follower turns");
  command->add_flag("--ablations", flags->ablations,
                    "measure the checkpoint, as it is served, without each of its parts too");
}

}  // namespace duet::evaluation::program
