#include "contrib/load/program/report_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::contrib::load::program {
namespace {

using test::IsOk;
using test::StatusIs;
using ::testing::HasSubstr;

TEST(WriteReportTest, FileOnStandardOutputReplacesTheText) {
  const test::TemporaryFolder folder;
  const std::vector<ReportFile> files = {{"", [] { return "never"; }},
                                         {folder / "load.csv", [] { return "csv"; }},
                                         {"-", [] { return "json"; }}};
  std::ostringstream out;
  EXPECT_THAT(WriteReport("text", files, &out), IsOk());
  EXPECT_EQ(out.str(), "json");
  EXPECT_EQ(test::ReadTestFile(folder / "load.csv"), "csv");
}

TEST(WriteReportTest, FullStandardOutputIsAnError) {
  std::ofstream out("/dev/full");
  EXPECT_THAT(
      WriteReport("text", {}, &out),
      StatusIs(absl::StatusCode::kAborted, HasSubstr("standard output: cannot write all of it")));
}

}  // namespace
}  // namespace duet::contrib::load::program
