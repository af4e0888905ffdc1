#ifndef DUET_TESTS_FORMATS_FBX_FBX_FIXTURE_H_
#define DUET_TESTS_FORMATS_FBX_FBX_FIXTURE_H_

#include <cstdlib>
#include <filesystem>
#include <string>

#include "gtest/gtest.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {

inline constexpr char kFbxProgramVariable[] = "DUET_FBX_PROGRAM";

inline std::string Variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Runs the built duet-fbx, or skips.
class FbxTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path program =
        std::filesystem::path(Variable("DUET_BIN_DIR")) / "duet-fbx";
    if (!std::filesystem::exists(program))
      GTEST_SKIP() << "duet-fbx is not built; it needs libassimp-dev (CMake option DUET_FBX)";
    setenv(kFbxProgramVariable, program.c_str(), 1);
  }
  void TearDown() override { unsetenv(kFbxProgramVariable); }

  const TemporaryFolder temporary_;
};

}  // namespace duet::test

#endif  // DUET_TESTS_FORMATS_FBX_FBX_FIXTURE_H_
