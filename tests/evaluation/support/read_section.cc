#include "tests/evaluation/support/read_section.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace duet::test {

nlohmann::json ReadSection(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  EXPECT_EQ(files.size(), 1u);
  if (files.size() != 1) return nullptr;
  return nlohmann::json::parse(ReadTestFile(files.front()));
}

std::vector<std::string> RowNames(const nlohmann::json& table) {
  std::vector<std::string> names;
  for (const nlohmann::json& row : table.at("rows")) names.push_back(row.at("name"));
  return names;
}

}  // namespace duet::test
