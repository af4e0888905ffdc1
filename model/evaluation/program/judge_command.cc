#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
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
  int parts = 0;  // of a cross-validation; 0: none
  judge::MotionClassifierOptions options;
};

// Sets the direction that a program can derive from a pair, in place of the one from a capture's
// setup.
void FaceFollowers(dataset::Dataset* dataset) {
  for (dataset::Sequence& sequence : dataset->sequences) {
    sequence.partner_direction = classifier::DirectionToFollower(dataset->skeleton, sequence.pair);
  }
}

void Test(const judge::MotionClassifier& judge, const dataset::Dataset& dataset,
          const std::vector<int>& sequences, metrics::Confusion* confusion) {
  confusion->AddLikeliest(
      metrics::ClassesOf(dataset, sequences),
      judge.Probabilities(dataset, metrics::CapturedMotions(dataset, sequences)));
}

double Accuracy(const judge::MotionClassifier& judge, const dataset::Dataset& dataset,
                const std::vector<int>& sequences) {
  metrics::Confusion confusion(dataset.class_count());
  Test(judge, dataset, sequences, &confusion);
  return confusion.Accuracy();
}

// The sequences with part `part` of `parts` of every class to test on.
dataset::Split LeavePartOut(const dataset::Dataset& dataset, int part, int parts) {
  dataset::Split split;
  std::vector<int> seen(static_cast<size_t>(dataset.class_count()));
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    const int of_class = seen[static_cast<size_t>(dataset.sequences[i].interaction_class)]++;
    (of_class % parts == part ? split.test : split.train).push_back(static_cast<int>(i));
  }
  return split;
}

// "kick: 8 of 10 recognised; 2 taken for shove".
std::string Recognised(const dataset::Dataset& dataset, const metrics::Confusion& confusion,
                       int meant) {
  int total = 0;
  std::string others;
  for (int c = 0; c < dataset.class_count(); ++c) {
    const int count = confusion.count(meant, c);
    total += count;
    if (c == meant || count == 0) continue;
    absl::StrAppend(&others, others.empty() ? "; " : ", ", count, " taken for ",
                    dataset.classes[static_cast<size_t>(c)]);
  }
  return absl::StrCat(dataset.classes[static_cast<size_t>(meant)], ": ",
                      confusion.count(meant, meant), " of ", total, " recognised", others);
}

// Tells whether the classes can be told apart: every follower is judged once, by a judge that was
// trained without its part.
absl::Status CrossValidate(const dataset::Dataset& dataset, const Arguments& arguments) {
  metrics::Confusion confusion(dataset.class_count());
  for (int part = 0; part < arguments.parts; ++part) {
    const dataset::Split split = LeavePartOut(dataset, part, arguments.parts);
    if (split.test.empty()) continue;
    const absl::StatusOr<judge::MotionClassifier> judge = judge::MotionClassifier::Train(
        dataset, metrics::CapturedMotions(dataset, split.train), arguments.options);
    if (!judge.ok()) return judge.status();
    Test(*judge, dataset, split.test, &confusion);
  }
  for (int c = 0; c < dataset.class_count(); ++c) {
    if (std::isnan(confusion.ClassAccuracy(c))) continue;
    std::cout << Recognised(dataset, confusion, c) << "\n";
  }
  std::cout << absl::StrFormat("%.1f %% of the held-out followers classified correctly\n",
                               100 * confusion.Accuracy());
  return absl::OkStatus();
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
  if (arguments.parts > 0) {
    absl::Status status = CrossValidate(*dataset, arguments);
    if (!status.ok()) return status;
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
  CLI::Option* hold_out =
      command->add_option("--hold-out", arguments->hold_out,
                          "subject held out of training; the classifier is tested on it");
  command
      ->add_option("--parts", arguments->parts,
                   "also test every follower with a classifier that was trained without its part "
                   "of the data; number of parts")
      ->check(CLI::Range(2, 1000))
      ->excludes(hold_out);
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
