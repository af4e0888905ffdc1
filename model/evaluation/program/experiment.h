#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/base/program_flags.h"
#include "model/body/grade.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/judge/judge.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/report/report.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::evaluation::program {

// What commands share: their flags, the models that a command line names, people left out of
// training, on whom models are measured, and the answers of models to captured leaders.

// An option whose default --help shows.
template <typename Value>
CLI::Option* AddOption(const char* name, Value* value, const char* help, CLI::App* command) {
  return command->add_option(name, *value, help)->capture_default_str();
}
// The same for a number, or several, from `least` to `most`.
template <typename Value, typename Number>
CLI::Option* AddNumber(const char* name, Value* value, Number least, Number most, const char* help,
                       CLI::App* command) {
  return AddOption(name, value, help, command)->check(base::InRange(least, most));
}
// The same for values of `among`, separated by commas.
CLI::Option* AddNames(const char* name, std::vector<std::string>* values,
                      const std::vector<std::string>& among, const char* help, CLI::App* command);
// A folder; the option is required unless there is a default.
CLI::Option* AddFolder(const char* name, std::string* folder, const char* help, CLI::App* command);

// What a request to a model has beside leader, labels and seed.
struct Asked {
  std::string start = "none";  // what it tells of the follower's first frame, or "root" or "pose"
  int samples = 1;             // answers to each leader; a model that does not sample gives one
  float variety = 1;
  uint64_t seed = 0;  // of a whole set of answers
  int candidates = engine::kDefaultCandidates;
  float reaction = 1;  // engine::Sampling::reaction
  // Answered live, with so many frames of delay. Absent: with the whole leader known.
  std::optional<int> live_delay = std::nullopt;
};

// The flags that commands may have. What a command sets before it adds them are the defaults.
struct ExperimentFlags {
  std::string data;
  std::vector<std::string> subjects;

  // Models: exactly one kind.
  std::vector<std::string> runs;  // [NAME=]RUNS each, a model per fold
  std::string checkpoint;         // one model for every fold
  bool embedded = false;          // likewise, the one inside the program
  bool as_served = false;         // finished as a server finishes them (engine::MakeSynthesizer)

  std::vector<std::string> starts = {"none", "pose"};  // a row of each model for each
  Asked asked;
};

// --data, --subjects
void AddExperimentFlags(ExperimentFlags* flags, CLI::App* command);
// --runs, --checkpoint, --embedded, --as-served
void AddModelFlags(ExperimentFlags* flags, CLI::App* command);
// --starts
void AddStartsFlag(ExperimentFlags* flags, CLI::App* command);
// --samples, --variety, --candidates, --reaction, --seed, --live
void AddSamplingFlags(Asked* asked, CLI::App* command);
// All of them.
void AddAnswersFlags(ExperimentFlags* flags, CLI::App* command);

using SharedSynthesizer = std::shared_ptr<const engine::Synthesizer>;

// A model by its name in the tables, its generator for the fold without a subject, and what it is
// asked.
struct FoldModel {
  std::string name;
  std::function<absl::StatusOr<SharedSynthesizer>(const std::string& subject)> load;
  Asked asked;
};

// Runs of duet-train and their name in tables: "ours=DIR", or "DIR", which is named by its last
// part. Errors: INVALID_ARGUMENT.
struct NamedRuns {
  std::string name;
  std::filesystem::path folder;
};
absl::StatusOr<NamedRuns> ParseRuns(const std::string& text);

// The only checkpoint below a run's folder, <run>/checkpoint/<name>/<version>. Errors: NOT_FOUND.
absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const std::filesystem::path& run);

// The models that flags name; a fold's is of <runs>/<subject>, as written by duet-train --protocol
// loso. Errors: INVALID_ARGUMENT for runs without a name; those of reading a checkpoint.
absl::StatusOr<std::vector<FoldModel>> OpenModels(const ExperimentFlags& flags);

// One subject left out of training.
struct Fold {
  std::string subject;
  dataset::Split split;
};

// A fold for each subject in `asked`, or, if it is empty, for every subject of the data set.
// Errors: INVALID_ARGUMENT for a data set that names no subject; LeaveSubjectOut's.
absl::StatusOr<std::vector<Fold>> LeaveOut(const dataset::Dataset& dataset,
                                           const std::vector<std::string>& asked);

// The data, folds and models that the flags name: every model once for each start, which its name
// shows ("+root", "+pose").
struct Experiment {
  dataset::Dataset dataset;
  std::vector<Fold> folds;
  std::vector<FoldModel> models;
};

// Errors: those of ReadDataset, LeaveOut and OpenModels.
absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags);

// "sbu, 282 sequences", for a section's settings.
std::string DescribeData(const dataset::Dataset& dataset);

// A section with this paragraph and the settings of every experiment: the data, the subjects left
// out, and how the models' answers are finished.
report::Section BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                const std::string& text);

// FAILED_PRECONDITION if a model's classes or joints differ from the data's, or if it does not
// accept the start.
absl::Status CheckModelTakes(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                             const std::string& start);

// The label vector of one class at weight 1. Shapes: returns [classes].
std::vector<float> OneClass(int classes, int interaction_class);

// A leader, and the labels and the seed to answer it with.
struct LabelledLeader {
  const dataset::Sequence* sequence;
  std::vector<float> labels;
  uint64_t seed = 0;
};

// The followers of many leaders, as a server makes them, with several windows per evaluation of the
// network: much faster than one by one. Returns a follower for each, in order; fails if one fails.
absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    const Asked& asked);

// The seed of the n-th answer to a sequence. No two leaders share a seed: with common noise, their
// answers would vary less than in use.
uint64_t SeedOf(const Asked& asked, const dataset::Dataset& dataset, int sequence, int n);

// The answers to sequences of the data set, each in its own class at weight 1. Errors: those of
// CheckModelTakes and of the network. Shapes: returns [samples][sequences].
absl::StatusOr<metrics::SampledMotions> AnswerWithSamples(const engine::Synthesizer& synthesizer,
                                                          const dataset::Dataset& dataset,
                                                          const std::vector<int>& sequences,
                                                          const Asked& asked);

// Trains the judge of each fold, only on the captured followers of the fold's training sequences.
// Reports each on stderr. Errors: MotionClassifier::Train's.
absl::StatusOr<std::vector<judge::MotionClassifier>> TrainJudges(const dataset::Dataset& dataset,
                                                                 const std::vector<Fold>& folds);

// What a command measures when its flags have been parsed: the text, tables, figures and settings
// of a section.
using Measure = std::function<absl::StatusOr<report::Section>()>;

// The commands of duet-eval. Each adds its flags to its command line.
Measure AddFoldsCommand(CLI::App* command);
Measure AddSamplesCommand(CLI::App* command);
Measure AddPlausibleCommand(CLI::App* command);
Measure AddToldApartCommand(CLI::App* command);
Measure AddSweepCommand(CLI::App* command);
Measure AddMixesCommand(CLI::App* command);
Measure AddAugmentationCommand(CLI::App* command);
Measure AddLatentCommand(CLI::App* command);

// Adds all of them to `app`, each with --out, --id and --title. The one that a command line names
// stores in `chosen` what measures, prints the section and, with --out, writes it.
void AddCommands(CLI::App* app, std::function<absl::Status()>* chosen);

// Type names of folders on a command line: a section records them instead of the folders.
// "[NAME=]RUNS" keeps the name.
inline constexpr char kFolder[] = "FOLDER";
inline constexpr char kRuns[] = "[NAME=]RUNS";

// The command line that was parsed: every flag that was given, in the order in which they are
// declared.
std::string RecordedCommand(const CLI::App& command);

// What the commands measure, for their tests.

// told-apart

// Settings of told-apart classifiers. They see leader and follower, and vary people's proportions
// less than a judge does, since a limb of a wrong length may identify an answer.
judge::MotionClassifierOptions ToldApartOptions(uint64_t seed);

// The balanced accuracy of a new classifier that distinguishes synthesised from captured pairs.
// 0.5: indistinguishable; 1: always correct. It learns from answers to the training sequences and
// from their captured followers, and is tested on the same of the test sequences. Leaders and
// followers all pass the same filter (WithoutNoise), so that it cannot detect sensor noise. Errors:
// INVALID_ARGUMENT without training answers.
absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::MotionClassifierOptions& options);

// plausible

// What a viewer would notice in one pair. Cost: linear in the frames. Requires a skeleton that
// body::PairMeter::CanMeasure accepts, at least one frame and as many of the follower. Shapes:
// returns [PlausibleFigures]; NaN where there is nothing to measure.
std::vector<double> MeasurePlausibility(const motion::Skeleton& skeleton,
                                        const motion::Poses& leader, const motion::Poses& follower,
                                        double rate);
const std::vector<std::string>& PlausibleFigures();

// sweep: the effect of a class's weight in the label vector on a judge's probability of that class.
// Source: the paper's graded and negative labels (section 3.1), which it shows but does not
// measure.

// -1, -0.75, ..., 2: the weights of a sweep, in order.
const std::vector<double>& SweepWeights();

// One leader answered at every weight of one class: the only class (own == raised), or beside the
// leader's own class at weight 1.
struct SweepCurve {
  int own = 0;                                    // the class of the leader's interaction
  int raised = 0;                                 // the class whose weight is swept
  std::vector<std::vector<float>> probabilities;  // [weights][classes]
};

// Two tables for the own class alone, and two for another class beside it; a row for each class.
// The first has the shares of curves whose probability goes the way its weight goes (from 0 to 1,
// from 0 to -1) and that stay level; the second the mean probability at each weight.
std::vector<report::Table> SweepTables(const std::string& model,
                                       const std::vector<std::string>& classes,
                                       const std::vector<SweepCurve>& curves);

// augmentation

// A request for a synthetic motion.
struct SyntheticJob {
  dataset::Sequence sequence;  // a leader of its class; the follower has no positions
  std::vector<float> labels;   // [classes], the label vector
};

// The jobs for synthetic followers of every class; only the seed determines the draw.
//
// Leaders are those of `train`, those of each class in turn as often as needed, with variations:
// both people exchanged in half of the clips of symmetric classes, bodies larger or smaller by up
// to 8 %, turned by about 6 degrees, played up to 10 % faster or slower. Interaction match gives
// the leader's class a weight of 0.75 to 1.25. Interaction mix gives it 0.75 to 1, and one other
// class 0.1 to 0.35, so that the motion stays one of its class.
//
// Source: paper section 4 (300 synthetic motions, 50 a class, "25 + 25"), which does not say how it
//         varies leaders and weights; read as 25 by interaction match and 25 by interaction mix.
// Shapes: returns match + mix jobs per class, sorted by class. Requires a sequence of every class
// in `train`; mix above 0 requires two classes.
std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train, int match, int mix,
                                           uint64_t seed);

// mixes

// How a follower meets a leader, in numbers: how near it comes, what its hands do, how it recoils.
// Every feature is an extreme over the clip, and larger for more of it; therefore a mix can have
// the features of two classes at different times. Metres, and degrees for leaning. Requires
// CanMeasureMeeting, and a follower of as many frames as the leader. Shapes: returns
// [MeetingFeatures].
std::vector<double> MeasureMeeting(const motion::Skeleton& skeleton,
                                   const dataset::Sequence& sequence,
                                   const motion::Poses& follower);
std::vector<std::string> MeetingFeatures();
// Whether the skeleton has hips, two arms, a chest and a head.
bool CanMeasureMeeting(const motion::Skeleton& skeleton);

// The features of captured followers, by class. Shapes: [classes][features].
struct ClassGeometry {
  std::vector<std::vector<double>> means, deviations;

  // By how much the feature of a class exceeds that of another class, if this is more than their
  // spread; otherwise 0. A feature that exceeds it belongs to the class's own geometry.
  double Own(int of_class, int other, size_t feature) const;
};
ClassGeometry MeasureClasses(const dataset::Dataset& dataset, const std::vector<int>& sequences);

// An answer to two classes at once, and the answers to each of them by itself. All have one seed
// and one start, so that only the labels differ.
struct MixedAnswer {
  int leader = 0;
  int fold = 0;            // of the captures that say what belongs to a class
  int own = 0, other = 0;  // the class of the leader's interaction, and the one that is added
  // Of the mix and of the two single answers. Shapes: [MeetingFeatures].
  std::vector<double> mixed = {}, own_alone = {}, other_alone = {};
  std::vector<float> probabilities = {};  // the judge's of the mix [classes]
  double deviation = 0;                   // Deviation's
  body::Grade grade = {};
};

// The distance of a mix from the average of both single answers, over that of either single answer
// from it: 0 for the average, 1 for a single answer. NaN if the single answers are the same.
double Deviation(const motion::Poses& mixed, const motion::Poses& own, const motion::Poses& other);

// How much of each class's own geometry a mix keeps: 0 as in the other class's single answer, 1 as
// in its own; the mean over the features that are larger in the class, in captures by more than
// their spread, and in single answers by a good part of that. NaN if there is none.
struct Kept {
  double own = NAN, other = NAN;

  double weaker() const { return std::isnan(own + other) ? NAN : std::min(own, other); }
  double both() const { return std::isnan(weaker()) ? NAN : weaker() > 0.5; }  // are above half
};
// Shapes: folds [folds]; returns [answers].
std::vector<Kept> MeasureKept(const std::vector<MixedAnswer>& answers,
                              const std::vector<ClassGeometry>& folds);

// Answers to all leaders with the same weights, under the name that tables show.
using MixVariant = std::pair<std::string, std::vector<MixedAnswer>>;

// The figures of every variant with their intervals.
report::Table MixTable(const std::string& title, const std::vector<ClassGeometry>& folds,
                       const std::vector<MixVariant>& variants);

// A mean, and both ends of its 95 % interval.
struct Estimate {
  double mean, low, high;
};

// Estimates the mean by the bootstrap: leaders are drawn with all their values, because the answers
// to one leader are alike. NaN: no value. The same input gives the same result. Shapes: both
// [answers].
Estimate EstimateMean(const std::vector<int>& leaders, const std::vector<double>& values);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
