#ifndef DUET_MODEL_TRAINING_RUN_LOG_H_
#define DUET_MODEL_TRAINING_RUN_LOG_H_

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/training/epoch_trainer.h"

namespace duet::training {

// Appends one row for each epoch to a CSV file; a new file starts with the column names. Rows of
// epochs after `epoch`, which a run wrote before it was killed without saving its state, are
// dropped.
class RunLog {
 public:
  explicit RunLog(std::filesystem::path file) : file_(std::move(file)) {}

  absl::Status ResumeAt(int64_t epoch);
  absl::Status Append(const EpochReport& report);

 private:
  std::filesystem::path file_;
};

// "[#####.....] epoch 12/60  loss 3.214  val 0.61  0:14 left". One line, no line end.
std::string ProgressLine(const std::string& title, const EpochReport& report);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_RUN_LOG_H_
