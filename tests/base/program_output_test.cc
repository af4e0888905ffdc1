#include "model/base/program_output.h"

#include <fstream>
#include <sstream>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::base {
namespace {

TEST(ProgramOutputTest, KeepsTheExitCodeOfWhatIsWritten) {
  std::ostringstream out, err;
  out << "answer\n";
  EXPECT_THAT(FlushOutput(&out), IsOk());
  EXPECT_EQ(FinishOutput("duet", 0, &out, &err), 0);
  EXPECT_EQ(FinishOutput("duet", 42, &out, &err), 42);
  EXPECT_EQ(err.str(), "");
}

TEST(ProgramOutputTest, SuccessWithoutOutputIsNone) {
  std::ofstream full("/dev/full");
  std::ostringstream err;
  full << "answer\n";
  EXPECT_EQ(FinishOutput("duet", 0, &full, &err), 1);
  EXPECT_EQ(err.str(), "duet: standard output: cannot write all of it: No space left on device\n");
  EXPECT_EQ(FinishOutput("duet", 42, &full, &err), 42) << "which has its own message";
  EXPECT_THAT(FlushOutput(&full),
              StatusIs(absl::StatusCode::kAborted, StartsWith("standard output: ")));
}

}  // namespace
}  // namespace duet::base
