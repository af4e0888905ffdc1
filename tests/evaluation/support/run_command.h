#ifndef DUET_TESTS_EVALUATION_SUPPORT_RUN_COMMAND_H_
#define DUET_TESTS_EVALUATION_SUPPORT_RUN_COMMAND_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/program/commands.h"

namespace duet::test {

using AddCommand = void (*)(CLI::App*, evaluation::program::ChosenCommand*);

// Runs a command of duet-eval. `words`: the command line without the program's name.
// Errors: INVALID_ARGUMENT for words that cannot be parsed; those of the command.
absl::Status RunCommand(AddCommand add, std::vector<std::string> words);

// The same with --out FOLDER; returns the section that the command writes.
absl::StatusOr<nlohmann::json> RunForSection(AddCommand add, std::vector<std::string> words);

// The names of a table's rows.
std::vector<std::string> RowNames(const nlohmann::json& table);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_RUN_COMMAND_H_
