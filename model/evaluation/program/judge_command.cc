#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/status_macros.h"
#include "model/classifier/classifier_files.h"
#include "model/classifier/classifier_input.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/flags.h"

namespace duet::evaluation::program {
namespace {

struct JudgeArguments {
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
absl::Status CrossValidate(const dataset::Dataset& dataset, const JudgeArguments& arguments) {
  metrics::Confusion confusion(dataset.class_count());
  for (int part = 0; part < arguments.parts; ++part) {
    const dataset::Split split = LeavePartOut(dataset, part, arguments.parts);
    if (split.test.empty()) continue;
    DUET_TRY(const judge::MotionClassifier judge,
             judge::MotionClassifier::Train(dataset, metrics::CapturedMotions(dataset, split.train),
                                            arguments.options));
    Test(judge, dataset, split.test, &confusion);
  }
  for (int c = 0; c < dataset.class_count(); ++c) {
    if (std::isnan(confusion.ClassAccuracy(c))) continue;
    std::cout << Recognised(dataset, confusion, c) << "\n";
  }
  std::cout << absl::StrFormat("%.1f %% of the held-out followers classified correctly\n",
                               100 * confusion.Accuracy());
  return absl::OkStatus();
}

absl::Status RunJudge(const JudgeArguments& arguments) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  FaceFollowers(&dataset);
  dataset::Split split{dataset::AllSequences(dataset), {}};
  if (!arguments.hold_out.empty()) {
    DUET_TRY(split, LeaveSubjectOut(dataset, arguments.hold_out));
  }
  if (arguments.parts > 0) {
    DUET_RETURN_IF_ERROR(CrossValidate(dataset, arguments));
  }
  DUET_TRY(const judge::MotionClassifier judge,
           judge::MotionClassifier::Train(dataset, metrics::CapturedMotions(dataset, split.train),
                                          arguments.options));
  std::cout << absl::StrFormat("trained on %d followers of %d classes\n", split.train.size(),
                               dataset.class_count());
  if (!split.test.empty()) {
    metrics::Confusion confusion(dataset.class_count());
    Test(judge, dataset, split.test, &confusion);
    std::cout << absl::StrFormat("%d held-out followers of %s: %.1f %% classified correctly\n",
                                 split.test.size(), arguments.hold_out, 100 * confusion.Accuracy());
  }
  absl::Status status = classifier::WriteClassifier(arguments.out, judge.Parts(dataset));
  if (status.ok()) std::cout << "wrote " << arguments.out << "\n";
  return status;
}

}  // namespace

void AddJudgeCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("judge", "Train a classifier of followers, for the filter of duet batch", RunJudge,
                 app, chosen);
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
  AddNumber("--networks", &arguments->options.members, 1, 100,
            "number of networks with different seeds; their probabilities are averaged", command);
  AddNumber("--epochs", &arguments->options.epochs, 0, 10000, "training epochs", command);
  AddOption("--seed", &arguments->options.seed, "seed of the networks", command);
}

}  // namespace duet::evaluation::program
