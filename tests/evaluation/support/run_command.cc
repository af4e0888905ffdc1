#include "tests/evaluation/support/run_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

// The only section in a folder of results. Fails the test, and returns null, unless there is one.
nlohmann::json ReadSection(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  EXPECT_EQ(files.size(), 1u);
  if (files.size() != 1) return nullptr;
  return nlohmann::json::parse(ReadTestFile(files.front()));
}

}  // namespace

std::vector<std::string> RowNames(const nlohmann::json& table) {
  std::vector<std::string> names;
  for (const nlohmann::json& row : table.at("rows")) names.push_back(row.at("name"));
  return names;
}

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
