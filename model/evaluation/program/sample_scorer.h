#ifndef DUET_MODEL_EVALUATION_PROGRAM_SAMPLE_SCORER_H_
#define DUET_MODEL_EVALUATION_PROGRAM_SAMPLE_SCORER_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/sampled_scores.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/report/metric_tables.h"

namespace duet::evaluation::program {

// One fold: the subject left out, and its judge with its results for the captured followers, as
// captured and after the noise filter.
struct SampleFold {
  std::string subject;
  dataset::Split split;
  std::vector<judge::MotionClassifier> judge;  // one
  metrics::JudgedFold captured, captured_filtered;
};

// Scores many answers to each leader, leaving one subject out at a time, every row in the same
// folds with the same judges.
class SampleScorer {
 public:
  // `dataset` must outlive the scorer. Trains the judges. Errors: those of TrainFoldJudge.
  static absl::StatusOr<SampleScorer> Create(const dataset::Dataset& dataset,
                                             const std::vector<std::string>& subjects);

  const std::vector<SampleFold>& folds() const { return folds_; }

  // Figures by class with the names of report/sample_tables.h. Shapes: answers [folds].
  absl::StatusOr<report::MethodFigures> Score(
      const std::string& row, const std::vector<metrics::SampledMotions>& answers) const;
  absl::StatusOr<report::MethodFigures> ScoreCaptured() const;

  // The judges of the figures, for the settings of a section.
  std::vector<std::pair<std::string, std::string>> JudgeSettings() const;

 private:
  explicit SampleScorer(const dataset::Dataset& dataset) : dataset_(&dataset) {}
  absl::Status AddJudged(const std::vector<metrics::SampledMotions>& answers,
                         report::MethodFigures* figures) const;

  const dataset::Dataset* dataset_;
  std::vector<SampleFold> folds_;
};

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_SAMPLE_SCORER_H_
