// Commands that run networks of their own: classifiers (told-apart, sweep, augmentation) and
// latent.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/evaluation/judge/judge.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/report.h"
#include "model/motion/filter.h"
#include "model/training/augment.h"

namespace duet::evaluation::program {
namespace {

// told-apart

struct ToldApartFlags : ExperimentFlags {
  std::vector<uint64_t> seeds = {1, 2, 3};
};

constexpr int kCaptured = 0, kSynthesised = 1;

// A data set of two classes: pairs with captured followers, and pairs with synthesised ones.
dataset::Dataset PairsToTell(const dataset::Dataset& dataset,
                             const std::vector<metrics::ScoredMotion>& answers) {
  dataset::Dataset pairs = dataset;
  pairs.classes = {"captured", "synthesised"};
  pairs.symmetric = pairs.handed = pairs.touches = {false, false};
  pairs.sequences.clear();
  for (const metrics::ScoredMotion& answer : answers) {
    dataset::Sequence sequence = SequenceOf(dataset, answer);
    motion::ClipPair& pair = sequence.pair;
    const double rate = pair.leader.frame_rate_hz;
    pair.leader.poses = motion::WithoutNoise(pair.leader.poses, rate);
    pair.follower.poses = motion::WithoutNoise(pair.follower.poses, rate);
    sequence.interaction_class = kCaptured;
    pairs.sequences.push_back(sequence);
    pair.follower.poses = motion::WithoutNoise(answer.follower, rate);
    sequence.interaction_class = kSynthesised;
    pairs.sequences.push_back(std::move(sequence));
  }
  return pairs;
}

// The accuracies of one model. Shapes: returns [classifier seeds][folds].
absl::StatusOr<std::vector<std::vector<double>>> Accuracies(const Experiment& experiment,
                                                            const FoldModel& model,
                                                            const std::vector<uint64_t>& seeds) {
  std::vector<std::vector<double>> accuracies(seeds.size());
  for (const Fold& fold : experiment.folds) {
    const dataset::Dataset& dataset = experiment.dataset;
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_TRY(auto training,
             AnswerWithSamples(*synthesizer, dataset, fold.split.train, model.asked));
    DUET_TRY(auto test, AnswerWithSamples(*synthesizer, dataset, fold.split.test, model.asked));
    for (size_t i = 0; i < seeds.size(); ++i) {
      DUET_TRY(const double accuracy,
               ToldApart(dataset, training.front(), test.front(), ToldApartOptions(seeds[i])));
      std::cerr << absl::StrFormat("%s without %s, classifier %d: %.3f\n", model.name, fold.subject,
                                   seeds[i], accuracy);
      accuracies[i].push_back(accuracy);
    }
  }
  return accuracies;
}

absl::StatusOr<report::Section> RunToldApart(const ToldApartFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  report::Section section = BeginExperiment(
      flags, experiment,
      "A fresh classifier that sees leader and follower learns to tell a fold's answers to its "
      "training leaders from the captured pairs of the same people, and is tested on the left-out "
      "person: on that fold's answers to leaders never seen, and on the captured pairs. Both sides "
      "go through the same Gaussian of 0.1 s, so that a capture's noise gives nothing away.");
  report::Table& table = section.tables.emplace_back();
  table.title = "Balanced accuracy of telling synthesised from captured pairs";
  for (const Fold& fold : experiment.folds) table.columns.push_back(fold.subject);
  table.columns.insert(table.columns.end(), {"mean", "spread"});
  table.decimals = 3;
  table.notes = {
      "0.5: cannot be told apart; 1: always. A column is a left-out person; spread: the standard "
      "deviation of the mean over the classifiers' seeds."};
  for (const FoldModel& model : experiment.models) {
    DUET_TRY(const auto accuracies, Accuracies(experiment, model, flags.seeds));
    std::vector<double> values = report::ColumnMeans(accuracies), means;
    for (const std::vector<double>& of_folds : accuracies) means.push_back(base::Mean(of_folds));
    const base::MeanAndDeviation of_seeds = base::Summarise(means);
    values.insert(values.end(), {of_seeds.mean, of_seeds.deviation});
    table.rows.push_back({model.name, std::move(values)});
  }
  return section;
}

// sweep

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

// augmentation

constexpr double kLeastOwn = 0.75, kMostOwn = 1.25, kMostOwnMixed = 1;
constexpr double kLeastOther = 0.1, kMostOther = 0.35;

training::CommonSettings::Augmentation Variations() {
  training::CommonSettings::Augmentation augmentation;
  augmentation.set_swap_roles(0.5);
  augmentation.set_body_scale(0.08);
  augmentation.set_time_warp(0.1);
  augmentation.set_leader_yaw(0.1);
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
    tables[1].rows.push_back({row.name + ", deviation", report::ColumnDeviations(gains)});
  }
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

// latent

// Of the map that make_report.py draws: the effective number of neighbours, lowered for few clips,
// and the seed of its start.
constexpr int kPerplexity = 30, kMapSeed = 1;

std::string FigureName(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    c = absl::ascii_isalnum(byte) ? absl::ascii_tolower(byte) : '_';
  }
  return text;
}

// Measures one latent space: a figure and a row of the table. `clips`: sequences to show.
absl::Status AddSpace(const dataset::Dataset& dataset, const std::string& name,
                      const checkpoint::Checkpoint& checkpoint, const std::vector<int>& clips,
                      bool labelled, report::Section* section) {
  DUET_TRY(const metrics::FeatureSet features,
           judge::LatentFeatures(checkpoint, dataset, clips, labelled));
  const std::vector<int> classes = metrics::ClassesOf(dataset, clips);
  section->tables.front().rows.push_back({name, {metrics::NeighbourAccuracy(features, classes)}});
  section->figures.push_back({FigureName(name),
                              absl::StrCat("Latent space of ", name, " left out: t-SNE of ",
                                           clips.size(), " clips, one point each."),
                              {{"kind", "latent"},
                               {"title", name},
                               {"class_names", dataset.classes},
                               {"classes", classes},
                               {"features", features},
                               {"perplexity", kPerplexity},
                               {"seed", kMapSeed}}});
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunLatent(const ExperimentFlags& flags) {
  ExperimentFlags without_models = flags;
  without_models.runs.clear();
  DUET_TRY(Experiment experiment, OpenExperiment(without_models));
  if (flags.subjects.empty()) experiment.folds.resize(1);
  report::Section section = BeginExperiment(
      flags, experiment,
      "A clip is one point: the concatenated output of the generator's encoders, averaged over the "
      "clip's frames, drawn by t-SNE. Each fold's model has a space of its own.");
  section.text.push_back(
      "A model with a multi-hot embedding receives the class that colours the point as its label, "
      "so part of the order comes from the input. The same model with all labels zero shows what "
      "it infers from the leader only.");
  section.tables = {{"Share of clips whose nearest neighbour is of their class", {"in the space"}}};
  section.tables.front().decimals = 3;
  const std::vector<int> clips = dataset::AllSequences(experiment.dataset);
  for (const std::string& text : flags.runs) {
    DUET_TRY(const NamedRuns runs, ParseRuns(text));
    for (const Fold& fold : experiment.folds) {
      DUET_TRY(const checkpoint::Checkpoint checkpoint,
               ReadRunCheckpoint(runs.folder / fold.subject));
      DUET_RETURN_IF_ERROR(AddSpace(experiment.dataset, absl::StrCat(runs.name, ", ", fold.subject),
                                    checkpoint, clips, true, &section));
      // A model that reads labels is measured a second time without the label, which by itself
      // separates the classes.
      const auto& paper = std::get<checkpoint::PaperArchitecture>(checkpoint.manifest.architecture);
      if (paper.variant == checkpoint::GeneratorVariant::kUnlabelled) continue;
      DUET_RETURN_IF_ERROR(AddSpace(experiment.dataset,
                                    absl::StrCat(runs.name, ", label withheld, ", fold.subject),
                                    checkpoint, clips, false, &section));
    }
  }
  return section;
}

}  // namespace

judge::MotionClassifierOptions ToldApartOptions(uint64_t seed) {
  judge::MotionClassifierOptions options;
  options.sees = judge::Sees::kBoth;
  options.body_noise = 0.01;
  options.seed = seed;
  return options;
}

absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::MotionClassifierOptions& options) {
  const dataset::Dataset training = PairsToTell(dataset, training_answers);
  DUET_TRY(
      const auto classifier,
      judge::MotionClassifier::Train(
          training, metrics::CapturedMotions(training, dataset::AllSequences(training)), options));
  const dataset::Dataset test = PairsToTell(dataset, test_answers);
  const metrics::JudgedFold judged =
      classifier.Judge(test, metrics::CapturedMotions(test, dataset::AllSequences(test)));
  return base::Mean(metrics::AccuracyByClass({judged}, test.class_count()));
}

Measure AddToldApartCommand(CLI::App* command) {
  const auto flags = std::make_shared<ToldApartFlags>();
  AddAnswersFlags(flags.get(), command);
  AddOption("--seeds", &flags->seeds, "seeds; one classifier per seed", command)->delimiter(',');
  return [flags] { return RunToldApart(*flags); };
}

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

Measure AddLatentCommand(CLI::App* command) {
  const auto flags = std::make_shared<ExperimentFlags>();
  AddExperimentFlags(flags.get(), command);
  command
      ->add_option("--runs", flags->runs,
                   "output of duet-train --protocol loso; repeatable. Without --subjects, the "
                   "first subject's fold is shown")
      ->type_name(kRuns)
      ->required()
      ->allow_extra_args(false);
  return [flags] { return RunLatent(*flags); };
}

}  // namespace duet::evaluation::program
