#include "tests/evaluation/support/run_command.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "model/evaluation/program/experiment.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {

absl::StatusOr<nlohmann::json> RunForSection(std::vector<std::string> words) {
  const TemporaryFolder results;
  words.insert(words.end(), {"--out", results.path().string()});
  std::reverse(words.begin(), words.end());  // CLI11 takes the arguments in reverse
  CLI::App app;
  std::function<absl::Status()> chosen;
  evaluation::program::AddCommands(&app, &chosen);
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  if (absl::Status status = chosen(); !status.ok()) return status;
  return nlohmann::json::parse(
      ReadTestFile(std::filesystem::directory_iterator(results.path())->path()));
}

std::vector<std::string> RowNames(const nlohmann::json& table) {
  std::vector<std::string> names;
  for (const nlohmann::json& row : table.at("rows")) names.push_back(row.at("name"));
  return names;
}

}  // namespace duet::test
