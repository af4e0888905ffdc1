#ifndef DUET_TESTS_SUPPORT_DATA_FOLDER_H_
#define DUET_TESTS_SUPPORT_DATA_FOLDER_H_

#include <filesystem>
#include <optional>
#include <string>

namespace duet::test {

// A file or folder of the optional real captures, which are never part of the project: under
// $DUET_DATA_DIR, else ../shared/data beside the project. Nothing when it is not there: the test
// then skips itself.
//
//   const auto sbu = FindData("sbu");
//   if (!sbu) GTEST_SKIP() << kNoData;
std::optional<std::filesystem::path> FindData(const std::string& relative_path);

inline constexpr char kNoData[] = "needs real captures; set DUET_DATA_DIR to a folder with them";

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_DATA_FOLDER_H_
