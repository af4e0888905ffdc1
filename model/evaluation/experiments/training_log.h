#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TRAINING_LOG_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TRAINING_LOG_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::evaluation::experiments {

// Far above the longest run.
inline constexpr std::size_t kMaxTrainingLogBytes = std::size_t{64} << 20;

// The figures that duet-train logs, one a column and epoch.
struct TrainingLog {
  std::vector<double> epochs;                          // ascending
  std::map<std::string, std::vector<double>> columns;  // [epochs] each; NaN where there is none

  // Null where the log has no such column or no finite figure in it.
  const std::vector<double>* Find(const std::string& column) const;
};

// Reads log.csv: a line of column names, `epoch` among them, then one line an epoch. Empty fields
// and "nan" are missing figures.
// Errors: INVALID_ARGUMENT "source:line: ... came ..., wanted ...".
absl::StatusOr<TrainingLog> ParseTrainingLog(absl::string_view text, absl::string_view source);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TRAINING_LOG_H_
