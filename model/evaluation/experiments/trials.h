#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace duet::evaluation::experiments {

struct MeanAndDeviation {
  double mean = 0;
  double deviation = 0;  // with divisor n - 1; NaN for fewer than 2 values
};
// NaN for no value.
MeanAndDeviation Summarise(const std::vector<double>& values);

// Figures of a row over its trials. Shapes: [columns] each.
struct TrialSummary {
  std::string row;
  std::vector<double> means;
  std::vector<double> deviations;  // with divisor n - 1; NaN for fewer than 2 trials
  std::vector<double> above_zero;  // the share of trials with a figure above 0
};

// Figures of an experiment repeated: a row's values by column, trial by trial. Rows may miss
// trials.
class Trials {
 public:
  explicit Trials(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  // `trial` names what was drawn (split, seed): the same trials of two rows are a pair.
  // Shapes: values [columns].
  void Add(const std::string& row, const std::string& trial, std::vector<double> values);

  const std::vector<std::string>& columns() const { return columns_; }

  // Every row's figures, rows in the order of their first Add.
  std::vector<TrialSummary> Summaries() const;
  // How much larger every other row's figures are than those of row `base`, trial by trial, over
  // the trials that both have. Empty where there is no such row.
  std::vector<TrialSummary> Gains(const std::string& base) const;

 private:
  using Row = std::map<std::string, std::vector<double>>;  // by trial

  TrialSummary Summary(const std::string& name, const Row& row) const;

  std::vector<std::string> columns_;
  std::vector<std::pair<std::string, Row>> rows_;
};

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_
