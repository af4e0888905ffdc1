#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/experiments/data_half.h"
#include "model/evaluation/experiments/synthesize_jobs.h"
#include "model/evaluation/experiments/synthetic_plan.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/models.h"
#include "model/evaluation/program/section_flags.h"
#include "model/evaluation/report/metric_tables.h"
#include "model/evaluation/report/paper_tables.h"
#include "model/evaluation/report/trial_tables.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::string data;
  std::string runs;
  std::vector<uint64_t> seeds = {1, 2, 3, 4, 5};
  int repeats = 1;
  experiments::SyntheticPlanOptions plan;
  bool as_served = false;
  std::vector<std::string> synthetic;
  std::string write_jobs;
  int64_t epochs = judge::MotionClassifierOptions().epochs;
  SectionFlags section = {"40_augmentation", "Synthetic motion as training material (Table 6)"};
};

std::string MadeHere(const experiments::SyntheticPlanOptions& plan) {
  return absl::StrCat("captured + ", plan.match, " match + ", plan.mix, " mix");
}

absl::StatusOr<std::vector<experiments::SyntheticJob>> PlanHalf(const dataset::Dataset& dataset,
                                                                const dataset::Split& split,
                                                                const Arguments& arguments,
                                                                uint64_t seed) {
  if (arguments.plan.match + arguments.plan.mix < 1) {
    return absl::InvalidArgumentError(
        "--match and --mix: expected at least one motion a class, got 0 and 0");
  }
  if (arguments.plan.mix > 0 && dataset.class_count() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("--mix: expected 0 for data of one class, got ", arguments.plan.mix));
  }
  experiments::SyntheticPlanOptions options = arguments.plan;
  options.seed = seed;
  return PlanSyntheticSet(dataset, split.train, options);
}

absl::StatusOr<experiments::DataHalf> PrepareHalf(const dataset::Dataset& dataset,
                                                  const Arguments& arguments, uint64_t seed) {
  experiments::DataHalf half;
  half.seed = seed;
  absl::StatusOr<dataset::Split> split = SplitInHalves(dataset, seed);
  if (!split.ok()) return split.status();
  half.split = *std::move(split);
  absl::StatusOr<std::vector<experiments::SyntheticJob>> jobs =
      PlanHalf(dataset, half.split, arguments, seed);
  if (!jobs.ok()) return jobs.status();
  absl::StatusOr<SharedSynthesizer> model =
      LoadFoldModel(arguments.runs, absl::StrCat("half-", seed), arguments.as_served);
  if (!model.ok()) return model.status();
  absl::StatusOr<std::vector<dataset::Sequence>> synthetic =
      SynthesizeJobs(dataset, **model, *jobs);
  if (!synthetic.ok()) return synthetic.status();
  half.synthetic = *std::move(synthetic);
  return half;
}

absl::Status ReadSets(const dataset::Dataset& dataset, const std::vector<std::string>& folders,
                      std::vector<experiments::DataHalf>* halves) {
  std::vector<experiments::SyntheticSet> sets;
  for (const std::string& folder : folders) {
    absl::StatusOr<experiments::SyntheticSet> set = experiments::ReadSyntheticSet(dataset, folder);
    if (!set.ok()) return set.status();
    sets.push_back(*std::move(set));
  }
  return AddServedSets(sets, halves);
}

report::ResultSection MakeSection(const dataset::Dataset& dataset, const Arguments& arguments,
                                  const experiments::Trials& trials) {
  report::ResultSection section = BeginSection(
      arguments.section,
      "A classifier with the architecture of the discriminator learns to classify the follower's "
      "motion from half of the captured clips of each class, with and without synthetic followers, "
      "and is tested on the captured clips of the other half. The generator of the synthetic "
      "followers was trained on the same half only, and answers varied leaders of that half. A "
      "trial is one split and one seed of the classifier; trials of different rows are paired.");
  section.text.push_back(
      "Rows take equally many training steps, since longer training alone moves the accuracy; "
      "\"longer\" rows take the steps that the larger set needs for as many epochs. \"Synthetic "
      "alone\" never sees a captured follower.");
  report::Table means =
      report::MeansTable("Accuracy on captured followers, mean over the trials", trials);
  AddPrintedRows(report::PaperAugmentation(), &means);
  section.tables = {std::move(means),
                    report::DeviationsTable("Accuracy, standard deviation over the trials", trials),
                    report::GainsTable("Gain over captured followers alone, paired", trials,
                                       experiments::kCapturedRow)};
  section.settings = {
      {"data", dataset.name},
      {"halves (seeds)", absl::StrJoin(arguments.seeds, ", ")},
      {"classifiers a half", absl::StrCat(arguments.repeats)},
      {"classifier epochs", absl::StrCat(arguments.epochs)},
      {"synthetic motions a class",
       absl::StrCat(arguments.plan.match, " match + ", arguments.plan.mix, " mix")},
      {"in-process answers", arguments.as_served ? "as served" : "the network's own"},
      {"sets through the server", absl::StrCat(arguments.synthetic.size())}};
  return section;
}

absl::Status WriteJobs(const dataset::Dataset& dataset, const Arguments& arguments) {
  if (arguments.seeds.size() != 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("--seeds: expected one with --write-jobs, got ", arguments.seeds.size()));
  }
  const uint64_t seed = arguments.seeds.front();
  absl::StatusOr<dataset::Split> split = SplitInHalves(dataset, seed);
  if (!split.ok()) return split.status();
  absl::StatusOr<std::vector<experiments::SyntheticJob>> jobs =
      PlanHalf(dataset, *split, arguments, seed);
  if (!jobs.ok()) return jobs.status();
  return WriteSyntheticJobs(dataset, *jobs, seed, arguments.write_jobs);
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  if (!arguments.write_jobs.empty()) return WriteJobs(*dataset, arguments);
  std::vector<experiments::DataHalf> halves;
  for (const uint64_t seed : arguments.seeds) {
    absl::StatusOr<experiments::DataHalf> half = PrepareHalf(*dataset, arguments, seed);
    if (!half.ok()) return half.status();
    halves.push_back(*std::move(half));
  }
  absl::Status status = ReadSets(*dataset, arguments.synthetic, &halves);
  if (!status.ok()) return status;
  std::vector<std::string> columns = dataset->classes;
  columns.push_back("mean");
  experiments::Trials trials(std::move(columns));
  const experiments::HalfOptions options = {MadeHere(arguments.plan), arguments.epochs,
                                            arguments.repeats};
  for (const experiments::DataHalf& half : halves) {
    status = RunHalf(*dataset, half, options, &std::cerr, &trials);
    if (!status.ok()) return status;
  }
  return FinishSection(arguments.section, MakeSection(*dataset, arguments, trials));
}

}  // namespace

void AddAugmentationCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand(
      "augmentation", "A classifier with and without synthetic training motion (Table 6)");
  AddDataFlag(&arguments->data, command);
  CLI::Option* runs =
      command->add_option("--runs", arguments->runs, "output of duet-train --protocol half")
          ->type_name(kRuns);
  command->add_option("--seeds", arguments->seeds, "seeds of the halves; reads <runs>/half-<seed>")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--repeats", arguments->repeats, "classifiers trained on each half")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--epochs", arguments->epochs, "epochs of a classifier on the captured half")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--match", arguments->plan.match,
                   "synthetic motions per class with only its label")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command
      ->add_option("--mix", arguments->plan.mix,
                   "synthetic motions per class, mixed with another class")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command->add_flag("--as-served", arguments->as_served,
                    "finish in-process answers as a server does");
  command
      ->add_option("--synthetic", arguments->synthetic,
                   "data set that duet batch made from a manifest of --write-jobs; repeatable")
      ->type_name(kSet)
      ->allow_extra_args(false);
  CLI::Option* write_jobs =
      command
          ->add_option("--write-jobs", arguments->write_jobs,
                       "only write the leaders of one half's set and their manifest")
          ->type_name(kSet);
  write_jobs->excludes(runs);
  AddSectionFlags(&arguments->section, command);
  command->callback([arguments, chosen, runs, write_jobs] {
    if (runs->count() + write_jobs->count() == 0) throw CLI::RequiredError("--runs");
    *chosen = [arguments] { return Run(*arguments); };
  });
}

}  // namespace duet::evaluation::program
