#include <iostream>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "model/classifier/classifier_files.h"
#include "model/classifier/classifier_input.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/confusion.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/section_flags.h"

namespace duet::evaluation::program {
namespace {

struct Arguments {
  std::string data;
  std::string out;
  std::string hold_out;
  judge::MotionClassifierOptions options;
};

// Sets the direction that a program can derive from a pair, in place of the one from a capture's
// setup.
void FaceFollowers(dataset::Dataset* dataset) {
  for (dataset::Sequence& sequence : dataset->sequences) {
    sequence.partner_direction = classifier::DirectionToFollower(dataset->skeleton, sequence.pair);
  }
}

double Accuracy(const judge::MotionClassifier& judge, const dataset::Dataset& dataset,
                const std::vector<int>& sequences) {
  metrics::Confusion confusion(dataset.class_count());
  confusion.AddLikeliest(
      metrics::ClassesOf(dataset, sequences),
      judge.Probabilities(dataset, metrics::CapturedMotions(dataset, sequences)));
  return confusion.Accuracy();
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  FaceFollowers(&*dataset);
  dataset::Split split;
  split.train.resize(dataset->sequences.size());
  std::iota(split.train.begin(), split.train.end(), 0);
  if (!arguments.hold_out.empty()) {
    absl::StatusOr<dataset::Split> without = LeaveSubjectOut(*dataset, arguments.hold_out);
    if (!without.ok()) return without.status();
    split = *std::move(without);
  }
  const absl::StatusOr<judge::MotionClassifier> judge = judge::MotionClassifier::Train(
      *dataset, metrics::CapturedMotions(*dataset, split.train), arguments.options);
  if (!judge.ok()) return judge.status();
  std::cout << absl::StrFormat("trained on %d followers of %d classes\n", split.train.size(),
                               dataset->class_count());
  if (!split.test.empty()) {
    std::cout << absl::StrFormat("%d held-out followers of %s: %.1f %% classified correctly\n",
                                 split.test.size(), arguments.hold_out,
                                 100 * Accuracy(*judge, *dataset, split.test));
  }
  absl::Status status = classifier::WriteClassifier(arguments.out, judge->Parts(*dataset));
  if (status.ok()) std::cout << "wrote " << arguments.out << "\n";
  return status;
}

}  // namespace

void AddJudgeCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("judge", "Train a classifier of followers, for the filter of duet batch");
  AddDataFlag(&arguments->data, command);
  command->add_option("--out", arguments->out, "folder to write the classifier to")->required();
  command->add_option("--hold-out", arguments->hold_out,
                      "subject held out of training; the classifier is tested on it");
  command
      ->add_option("--networks", arguments->options.members,
                   "number of networks with different seeds; their probabilities are averaged")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--epochs", arguments->options.epochs, "training epochs")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "seed of the networks")
      ->capture_default_str();
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program
