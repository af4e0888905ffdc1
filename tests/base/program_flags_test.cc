#include "model/base/program_flags.h"

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "model/base/program_output.h"
#include "tests/support/matchers.h"

namespace duet::base {
namespace {

// A program with a command, as duet-eval has them.
class ProgramFlags : public ::testing::Test {
 protected:
  ProgramFlags() {
    app_.set_version_flag("--version", "program 1.2.3");
    app_.require_subcommand(1);
    CLI::App* command = app_.add_subcommand("fit", "Fits.");
    command->add_option("--data", data_)->required();
    command->add_option("--seed", seed_);
    command->add_option("--threads", threads_)->check(InRange(1, 256));
    command->add_option("--ratio", ratio_)->check(InRange(0.5, 2.0));
  }

  std::optional<int> Parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "program");
    return ParseFlags(static_cast<int>(arguments.size()), arguments.data(), &app_, &out_, &err_);
  }

  // The first line of the error.
  std::string Error(const std::vector<const char*>& arguments) {
    err_.str("");
    EXPECT_EQ(Parse(arguments), 2);
    EXPECT_THAT(err_.str(), HasSubstr("\nRun with --help for more information.\n"));
    return err_.str().substr(0, err_.str().find('\n'));
  }

  CLI::App app_{"Fits models.", "program"};
  std::string data_;
  uint64_t seed_ = 0;
  double ratio_ = 0;
  int threads_ = 1;
  std::ostringstream out_, err_;
};

TEST_F(ProgramFlags, ValidCommandLineHasNoExitCode) {
  EXPECT_EQ(Parse({"fit", "--data", "x", "--seed", "3"}), std::nullopt);
  EXPECT_EQ(data_, "x");
  EXPECT_EQ(seed_, 3u);
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(ProgramFlags, AnswersGoToStandardOutput) {
  EXPECT_EQ(Parse({"--version"}), 0);
  EXPECT_EQ(out_.str(), "program 1.2.3\n");
  EXPECT_EQ(err_.str(), "");
}

TEST_F(ProgramFlags, ErrorsNameTheFlagAndTheValue) {
  EXPECT_THAT(Error({}), HasSubstr("subcommand is required"));
  EXPECT_THAT(Error({"fit"}), HasSubstr("--data"));
  EXPECT_THAT(Error({"fit", "--data", "x", "--fast"}), HasSubstr("--fast"));
  EXPECT_THAT(Error({"fit", "--data", "x", "--seed", "one"}), HasSubstr("--seed = one"));
  EXPECT_EQ(Error({"fit", "--data", "x", "--threads", "1000"}),
            "--threads: expected 1 to 256, got \"1000\"");
  // Comparisons with NaN are false.
  for (const char* ratio : {"3", "nan", "half"}) {
    EXPECT_EQ(Error({"fit", "--data", "x", "--ratio", ratio}),
              std::string("--ratio: expected 0.5 to 2, got \"") + ratio + "\"");
  }
}

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
