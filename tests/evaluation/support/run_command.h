#ifndef DUET_TESTS_EVALUATION_SUPPORT_RUN_COMMAND_H_
#define DUET_TESTS_EVALUATION_SUPPORT_RUN_COMMAND_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace duet::test {

// Runs a command of duet-eval with --out FOLDER; returns the section that it writes. `words`: the
// command line without the program's name. Errors: INVALID_ARGUMENT for words that cannot be
// parsed; those of the command.
absl::StatusOr<nlohmann::json> RunForSection(std::vector<std::string> words);

// The names of a table's rows.
std::vector<std::string> RowNames(const nlohmann::json& table);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_RUN_COMMAND_H_
