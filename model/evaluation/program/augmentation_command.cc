#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/evaluation/experiments/augmentation.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {
namespace {

struct AugmentationArguments {
  std::string data;
  std::string runs;
  std::vector<uint64_t> seeds = {1, 2, 3, 4, 5};
  int repeats = 1;
  experiments::SyntheticPlanOptions plan;
  bool as_served = false;
  int64_t epochs = judge::MotionClassifierOptions().epochs;
  SectionFlags section = {"40_augmentation", "Synthetic motion as training material (Table 6)"};
};

absl::StatusOr<std::vector<experiments::SyntheticJob>> PlanHalf(
    const dataset::Dataset& dataset, const dataset::Split& split,
    const AugmentationArguments& arguments, uint64_t seed) {
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
                                                  const AugmentationArguments& arguments,
                                                  uint64_t seed) {
  experiments::DataHalf half;
  half.seed = seed;
  DUET_TRY(half.split, SplitInHalves(dataset, seed));
  DUET_TRY(auto jobs, PlanHalf(dataset, half.split, arguments, seed));
  DUET_TRY(SharedSynthesizer model,
           LoadFoldModel(arguments.runs, absl::StrCat("half-", seed), arguments.as_served));
  DUET_TRY(half.synthetic, SynthesizeJobs(dataset, *model, jobs));
  return half;
}

report::ResultSection MakeSection(const dataset::Dataset& dataset,
                                  const AugmentationArguments& arguments,
                                  const std::vector<experiments::AccuracyRow>& rows) {
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
  section.tables = AccuracyTables(dataset.classes, rows);
  AddPrintedRows(report::PaperAugmentation(), &section.tables.front());
  section.settings = {{"data", dataset.name},
                      {"halves (seeds)", absl::StrJoin(arguments.seeds, ", ")},
                      {"classifiers a half", absl::StrCat(arguments.repeats)},
                      {"classifier epochs", absl::StrCat(arguments.epochs)},
                      {"synthetic motions a class",
                       absl::StrCat(arguments.plan.match, " match + ", arguments.plan.mix, " mix")},
                      {"models' answers", arguments.as_served ? "as served" : "the network's own"}};
  return section;
}

absl::Status RunAugmentation(const AugmentationArguments& arguments) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  std::vector<experiments::DataHalf> halves;
  for (const uint64_t seed : arguments.seeds) {
    DUET_TRY(halves.emplace_back(), PrepareHalf(dataset, arguments, seed));
  }
  std::vector<experiments::AccuracyRow> rows;
  const experiments::HalfOptions options = {
      absl::StrCat("captured + ", arguments.plan.match, " match + ", arguments.plan.mix, " mix"),
      arguments.epochs, arguments.repeats};
  for (const experiments::DataHalf& half : halves) {
    DUET_RETURN_IF_ERROR(RunHalf(dataset, half, options, &std::cerr, &rows));
  }
  return FinishSection(arguments.section, MakeSection(dataset, arguments, rows));
}

}  // namespace

void AddAugmentationCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "augmentation", "A classifier with and without synthetic training motion (Table 6)",
      RunAugmentation, app, chosen);
  AddDataFlag(&arguments->data, command);
  command->add_option("--runs", arguments->runs, "output of duet-train --protocol half")
      ->type_name(kRuns)
      ->required();
  AddOption("--seeds", &arguments->seeds, "seeds of the halves; reads <runs>/half-<seed>", command)
      ->delimiter(',');
  AddNumber("--repeats", &arguments->repeats, 1, 1000, "classifiers trained on each half", command);
  AddNumber("--epochs", &arguments->epochs, 1, 100000,
            "epochs of a classifier on the captured half", command);
  AddNumber("--match", &arguments->plan.match, 0, 10000,
            "synthetic motions per class with only its label", command);
  AddNumber("--mix", &arguments->plan.mix, 0, 10000,
            "synthetic motions per class, mixed with another class", command);
  command->add_flag("--as-served", arguments->as_served, "finish answers as a server does");
  AddSectionFlags(&arguments->section, command);
}

}  // namespace duet::evaluation::program
