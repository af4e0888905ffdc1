#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/evaluation/report/table.h"

namespace duet::evaluation::experiments {

struct MeanAndDeviation {
  double mean = 0;
  double deviation = 0;  // with divisor n - 1; NaN for fewer than 2 values
};
// NaN for no value.
MeanAndDeviation Summarise(const std::vector<double>& values);

// Figures of an experiment repeated: a row's values by column, trial by trial. Rows may miss
// trials.
class Trials {
 public:
  explicit Trials(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  // `trial` names what was drawn (split, seed): rows with the same name are a pair. Shapes: values
  // [columns].
  void Add(const std::string& row, const std::string& trial, std::vector<double> values);

  // Over a row's trials, rows in the order of their first Add.
  report::Table Means(std::string title) const;
  report::Table Deviations(std::string title) const;

  // Each row's difference to `base`, over the trials that both have: its mean, its deviation, the
  // share of trials in which it is above 0. A row of each: "+ synthetic", "+ synthetic, deviation",
  // "+ synthetic, share above 0".
  report::Table Gains(const std::string& base, std::string title) const;

 private:
  using Row = std::map<std::string, std::vector<double>>;  // by trial

  std::vector<double> Column(const Row& row, std::size_t column) const;
  Row Differences(const Row& row, const Row& base) const;

  std::vector<std::string> columns_;
  std::vector<std::pair<std::string, Row>> rows_;
};

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TRIALS_H_
