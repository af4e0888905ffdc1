#ifndef DUET_TESTS_EVALUATION_SUPPORT_READ_SECTION_H_
#define DUET_TESTS_EVALUATION_SUPPORT_READ_SECTION_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace duet::test {

// The only section in a folder of results. Fails the test, and returns null, unless there is one.
nlohmann::json ReadSection(const std::filesystem::path& folder);

// The names of a table's rows.
std::vector<std::string> RowNames(const nlohmann::json& table);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_READ_SECTION_H_
