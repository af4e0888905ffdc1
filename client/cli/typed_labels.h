#ifndef DUET_CLIENT_CLI_TYPED_LABELS_H_
#define DUET_CLIENT_CLI_TYPED_LABELS_H_

#include <memory>
#include <ostream>
#include <string>
#include <thread>

#include "absl/status/statusor.h"
#include "client/cli/live_arguments.h"
#include "client/cli/program_environment.h"
#include "client/live/leader_source.h"
#include "client/live/line_reader.h"
#include "client/live/live_run.h"

namespace duet::client::cli {

// Parses "hug=1 kick=0 ease=0.3": the weights of classes, and the seconds until they apply in full
// (default: 0). Errors: INVALID_ARGUMENT "expected ..., got ...".
absl::StatusOr<live::LabelCommand> ParseTypedLabels(const std::string& line);

// Changes the labels of a run as the user types, for as long as it lives. Does nothing if standard
// input is not a terminal, or is the leader.
class TypedLabels {
 public:
  TypedLabels(const LiveArguments& arguments, const ProgramEnvironment& environment,
              live::LiveRun* run);
  TypedLabels(const TypedLabels&) = delete;
  TypedLabels& operator=(const TypedLabels&) = delete;
  ~TypedLabels();

 private:
  void Read();

  live::LiveRun* const run_;
  std::ostream& err_;
  std::unique_ptr<live::LineReader> lines_;
  std::thread reader_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_TYPED_LABELS_H_
