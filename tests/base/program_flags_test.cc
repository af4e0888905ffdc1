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
    command->add_option("--share", share_);
    command->add_option("--threads", threads_)->check(InRange(1, 256));
    command->add_option("--ratio", share_)->check(InRange(0.5, 2.0));
    command->add_option("--protocol", protocol_)
        ->check(CLI::IsMember(std::vector<std::string>{"all", "loso", "half"}));
    command->add_option("--folder", folder_)->check(CLI::ExistingDirectory);
    command->add_flag("--quiet", quiet_);
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
  std::string data_, protocol_, folder_;
  uint64_t seed_ = 0;
  double share_ = 0;
  int threads_ = 1;
  bool quiet_ = false;
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

TEST_F(ProgramFlags, ErrorsStateWhatWasExpected) {
  EXPECT_EQ(Error({}), "A command is required");
  EXPECT_EQ(Error({"fly"}), "Unexpected argument \"fly\"");
  EXPECT_EQ(Error({"fit"}), "--data is required");
  EXPECT_EQ(Error({"fit", "--data", "x", "--fast"}), "Unexpected argument \"--fast\"");
  EXPECT_EQ(Error({"fit", "--data"}), "--data: expected a value, got none");
  EXPECT_EQ(Error({"fit", "--data", "x", "--seed", "one"}),
            "--seed: expected a whole number of 0 or more, got \"one\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--share", "half"}),
            "--share: expected a number, got \"half\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--threads", "1000"}),
            "--threads: expected 1 to 256, got \"1000\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--ratio", "3"}), "--ratio: expected 0.5 to 2, got \"3\"");
  // Comparisons with NaN are false.
  EXPECT_EQ(Error({"fit", "--data", "x", "--ratio", "nan"}),
            "--ratio: expected 0.5 to 2, got \"nan\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--ratio", "half"}),
            "--ratio: expected 0.5 to 2, got \"half\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--protocol", "none"}),
            "--protocol: expected all, loso or half, got \"none\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--folder", "/no/such"}),
            "--folder: expected a folder that exists, got \"/no/such\"");
  EXPECT_EQ(Error({"fit", "--data", "x", "--quiet=maybe"}),
            "--quiet: expected true or false, got \"maybe\"");
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
