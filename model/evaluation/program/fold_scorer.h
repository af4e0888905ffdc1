#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/sampled_scores.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {

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
  // Shapes: answers [folds], each as its fold's test sequences.
  absl::StatusOr<report::MethodFigures> Score(
      const std::string& row, const std::vector<std::vector<metrics::ScoredMotion>>& answers) const;
  // The same figures of the captured followers.
  absl::StatusOr<report::MethodFigures> ScoreCaptured() const;

  // Figures by class of many answers to each leader, with the names of report/sample_tables.h.
  // Requires kFiltered. Shapes: answers [folds].
  absl::StatusOr<report::MethodFigures> ScoreSamples(
      const std::string& row, const std::vector<metrics::SampledMotions>& answers) const;
  absl::StatusOr<report::MethodFigures> ScoreCapturedSamples() const;

  // The judges of the figures, for the settings of a section.
  std::vector<std::pair<std::string, std::string>> JudgeSettings() const;

 private:
  explicit FoldScorer(const dataset::Dataset& dataset) : dataset_(&dataset) {}
  absl::Status AddJudge(const Fold& fold, Judging judging);
  absl::Status AddJudged(const std::vector<metrics::SampledMotions>& answers,
                         report::MethodFigures* figures) const;

  const dataset::Dataset* dataset_;
  std::vector<Fold> folds_;
  std::vector<std::vector<metrics::ScoredMotion>> captured_;  // [folds]
  std::vector<judge::MotionClassifier> judges_;               // [folds], or empty
  // Of the captured followers. Shapes: as judges_; empty without the filter.
  std::vector<metrics::JudgedFold> judged_captured_, judged_filtered_;
};

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_SCORER_H_
