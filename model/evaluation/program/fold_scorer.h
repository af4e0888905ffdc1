#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {

// Trains a fold's judge, only on the captured followers of the fold's training sequences. Prints
// the time to stderr. Errors: MotionClassifier::Train's.
absl::StatusOr<judge::MotionClassifier> TrainFoldJudge(const dataset::Dataset& dataset,
                                                       const Fold& fold);

// The judge's name and hash, for the settings of a section.
std::pair<std::string, std::string> JudgeSetting(const Fold& fold,
                                                 const judge::MotionClassifier& judge);

// Shapes: [folds], each as its fold's test sequences.
using OneAnswerEach = std::vector<std::vector<metrics::ScoredMotion>>;

// Scores the answers to the leaders of every fold's left-out subject: every row in the same folds
// with the same judges.
class FoldScorer {
 public:
  // The judges' results: none; of motions; and also of motions after the noise filter.
  enum class Judging { kNone, kPlain, kFiltered };

  // `dataset` must outlive the scorer. Trains a judge for each fold unless `judging` is kNone.
  // Errors: those of TrainFoldJudge.
  static absl::StatusOr<FoldScorer> Create(const dataset::Dataset& dataset, std::vector<Fold> folds,
                                           Judging judging);

  const std::vector<Fold>& folds() const { return folds_; }

  // Figures by class of one answer to each leader; those of a judge if there is one.
  absl::StatusOr<report::MethodFigures> Score(const std::string& row,
                                              const OneAnswerEach& answers) const;
  // The same figures of the captured followers.
  absl::StatusOr<report::MethodFigures> ScoreCaptured() const;

  // Figures by class of many answers to each leader, with the names of report/metric_tables.h.
  // Requires kFiltered. Shapes: answers [folds].
  absl::StatusOr<report::MethodFigures> ScoreSamples(
      const std::string& row, const std::vector<metrics::SampledMotions>& answers) const;
  absl::StatusOr<report::MethodFigures> ScoreCapturedSamples() const;

  // The judges of the figures, for the settings of a section.
  std::vector<std::pair<std::string, std::string>> JudgeSettings() const;

 private:
  explicit FoldScorer(const dataset::Dataset& dataset) : dataset_(&dataset) {}
  // The judges' results. Requires judges.
  std::vector<metrics::JudgedFold> Judge(const OneAnswerEach& answers) const;

  const dataset::Dataset* dataset_;
  std::vector<Fold> folds_;
  OneAnswerEach captured_;
  std::vector<judge::MotionClassifier> judges_;  // [folds], or empty
  // Of the captured followers. Shapes: as judges_; empty without the filter.
  std::vector<metrics::JudgedFold> judged_captured_, judged_filtered_;
};

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_
