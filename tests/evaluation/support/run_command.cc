#include "tests/evaluation/support/run_command.h"

#include <algorithm>
#include <utility>

#include "tests/evaluation/support/read_section.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {

absl::Status RunCommand(AddCommand add, std::vector<std::string> words) {
  CLI::App app;
  evaluation::program::ChosenCommand chosen;
  add(&app, &chosen);
  std::reverse(words.begin(), words.end());  // CLI11 takes the arguments in reverse
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  return chosen();
}

absl::StatusOr<nlohmann::json> RunForSection(AddCommand add, std::vector<std::string> words) {
  const TemporaryFolder results;
  words.insert(words.end(), {"--out", results.path().string()});
  absl::Status status = RunCommand(add, std::move(words));
  if (!status.ok()) return status;
  return ReadSection(results.path());
}

}  // namespace duet::test
