#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/protocol/method.h"
#include "model/evaluation/protocol/protocol.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {

// Leaves one subject out at a time and scores every method in the same folds with the same judges.
// A method answers once; all its figures are of those answers. Reports each fold on stderr.
class FoldScorer {
 public:
  // A method for the fold without a subject; its Train is called with the fold's sequences.
  using MakeMethod =
      std::function<absl::StatusOr<std::unique_ptr<protocol::Method>>(const std::string& subject)>;

  // `dataset` must outlive the scorer. `judged`: train a judge for each fold, which accuracy, fid
  // and diversity need. Errors: LeaveSubjectOut's, MotionClassifier::Train's.
  static absl::StatusOr<FoldScorer> Create(const dataset::Dataset& dataset,
                                           const std::vector<std::string>& subjects, bool judged);

  absl::StatusOr<report::MethodFigures> Score(const std::string& row, const MakeMethod& make) const;
  // The captured followers of the same tests, as a row.
  absl::StatusOr<report::MethodFigures> ScoreCaptured() const;

  // The judges of the figures, for the settings of a section.
  std::vector<std::pair<std::string, std::string>> JudgeSettings() const;

 private:
  struct Fold {
    std::string subject;
    dataset::Split split;
    std::vector<judge::MotionClassifier> judge;  // one, or none
    metrics::JudgedFold captured;                // empty without a judge
  };

  explicit FoldScorer(const dataset::Dataset& dataset) : dataset_(&dataset) {}
  absl::Status AddJudge(Fold* fold) const;
  // Shapes: results [folds], the answers in each.
  absl::StatusOr<report::MethodFigures> Figures(
      const std::string& row, const std::vector<protocol::FoldResult>& results) const;

  const dataset::Dataset* dataset_;
  std::vector<Fold> folds_;
};

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_
