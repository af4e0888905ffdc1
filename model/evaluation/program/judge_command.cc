#include <cmath>
#include <iostream>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"

namespace duet::evaluation::program {
namespace {

struct JudgeArguments {
  std::string data;
  int parts = 5;
  int64_t epochs = judge::MotionClassifierOptions().epochs;
};

// Sets the horizontal direction from the leader's root to the follower's in the first frame: data
// of people's own states none, and hips are too noisy to place a partner by. Nothing for people who
// stand at almost the same place, as in a hug, where the direction is unreliable.
void FaceFollowers(dataset::Dataset* dataset) {
  constexpr float kLeastMetres = 0.3f;
  const int root = dataset->skeleton.root;
  for (dataset::Sequence& sequence : dataset->sequences) {
    motion::Vec3 toward = sequence.pair.follower.at(0, root) - sequence.pair.leader.at(0, root);
    toward.y = 0;
    sequence.partner_direction.reset();
    if (Norm(toward) >= kLeastMetres) sequence.partner_direction = toward;
  }
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

// Every follower is judged once, by a judge that was trained without its part.
absl::Status RunJudge(const JudgeArguments& arguments) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  FaceFollowers(&dataset);
  judge::MotionClassifierOptions options;
  options.epochs = arguments.epochs;
  metrics::Confusion confusion(dataset.class_count());
  for (int part = 0; part < arguments.parts; ++part) {
    const dataset::Split split = LeavePartOut(dataset, part, arguments.parts);
    if (split.test.empty()) continue;
    DUET_TRY(const judge::MotionClassifier judge,
             judge::MotionClassifier::Train(dataset, metrics::CapturedMotions(dataset, split.train),
                                            options));
    confusion.AddLikeliest(
        metrics::ClassesOf(dataset, split.test),
        judge.Probabilities(dataset, metrics::CapturedMotions(dataset, split.test)));
  }
  for (int c = 0; c < dataset.class_count(); ++c) {
    if (std::isnan(confusion.ClassAccuracy(c))) continue;
    std::cout << Recognised(dataset, confusion, c) << "\n";
  }
  std::cout << absl::StrFormat("%.1f %% of the held-out followers classified correctly\n",
                               100 * confusion.Accuracy());
  return absl::OkStatus();
}

}  // namespace

void AddJudgeCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("judge", "Whether a classifier tells the classes of captured followers apart",
                 RunJudge, app, chosen);
  AddDataFlag(&arguments->data, command);
  AddNumber("--parts", &arguments->parts, 2, 1000,
            "parts of the data; each is judged by a classifier that was trained on the others",
            command);
  AddNumber("--epochs", &arguments->epochs, 0, 10000, "training epochs", command);
}

}  // namespace duet::evaluation::program
