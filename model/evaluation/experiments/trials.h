#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace duet::evaluation::experiments {

// Figures of a row over its trials. Shapes: [columns] each.
struct TrialSummary {
  std::string row;
  std::vector<double> means;
  std::vector<double> deviations;  // with divisor n - 1; NaN for fewer than 2 trials
  std::vector<double> above_zero;  // the share of trials with a figure above 0
};

// The figures of a repeated experiment: a row's values by column and trial. Rows may lack trials.
class Trials {
 public:
  explicit Trials(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  // `trial` identifies what was drawn (split, seed): equal trials of two rows are a pair.
  // Shapes: values [columns].
  void Add(const std::string& row, const std::string& trial, std::vector<double> values);

  const std::vector<std::string>& columns() const { return columns_; }

  // Every row's figures, rows in the order of their first Add.
  std::vector<TrialSummary> Summaries() const;
  // The differences between every other row's figures and those of row `base`, over the trials that
  // both have. Empty without such a row.
  std::vector<TrialSummary> Gains(const std::string& base) const;

 private:
  using Row = std::map<std::string, std::vector<double>>;  // by trial

  TrialSummary Summary(const std::string& name, const Row& row) const;

  std::vector<std::string> columns_;
  std::vector<std::pair<std::string, Row>> rows_;
};

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_
