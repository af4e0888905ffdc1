#include "client/cli/stdio_command.h"

#include <sstream>
#include <string>
#include <vector>

#include "client/cli/program.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

using test::SwayingMotion;
using test::TemporaryFolder;

struct Answer {
  int exit_code = 0;
  std::string out, err;
};

// What `duet stdio` answers to each line.
std::vector<Answer> Ask(const std::string& lines) {
  std::istringstream in(lines);
  std::ostringstream out, err;
  EXPECT_EQ(RunProgram({"stdio"}, {nullptr, &out, &err, &in}), 0);
  EXPECT_EQ(err.str(), "");
  std::vector<Answer> answers;
  std::istringstream answered(out.str());
  for (std::string line; std::getline(answered, line);) {
    const auto header = nlohmann::json::parse(line);
    Answer answer;
    answer.exit_code = header["exit_code"];
    answer.out.resize(header["out_bytes"]);
    answer.err.resize(header["err_bytes"]);
    answered.read(answer.out.data(), static_cast<std::streamsize>(answer.out.size()));
    answered.read(answer.err.data(), static_cast<std::streamsize>(answer.err.size()));
    answers.push_back(std::move(answer));
  }
  return answers;
}

TEST(StdioCommandTest, AnswersEachLineInOrder) {
  const std::vector<Answer> answers =
      Ask("[\"--version\"]\n[\"convert\", \"/no/such.bvh\", \"--out\", \"-\"]\n[\"--version\"]\n");
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[0].exit_code, 0);
  EXPECT_THAT(answers[0].out, StartsWith("duet "));
  EXPECT_NE(answers[1].exit_code, 0);
  EXPECT_EQ(answers[1].out, "");
  EXPECT_NE(answers[1].err, "");
  EXPECT_EQ(answers[2].out, answers[0].out);
}

TEST(StdioCommandTest, PassesOnTheStandardOutputOfCommands) {
  TemporaryFolder folder;
  const std::string file = (folder / "leader.csv").string();
  motion::Clip leader;
  leader.joint_names = motion::SbuSkeleton().joint_names;
  leader.frame_rate_hz = 15;
  leader.poses = SwayingMotion(20, 15);
  ASSERT_THAT(formats::WritePair(file, {leader, leader}, motion::SbuSkeleton()), IsOk());
  const std::string words =
      nlohmann::json({"convert", file, "--out", "-", "--output-format", "npy"}).dump();
  const std::vector<Answer> answers = Ask(words + "\n" + words + "\n");
  ASSERT_THAT(answers, SizeIs(2));
  EXPECT_EQ(answers[0].exit_code, 0) << answers[0].err;
  EXPECT_THAT(answers[0].out, StartsWith("\x93NUMPY"));
  EXPECT_EQ(answers[1].out, answers[0].out);
}

TEST(StdioCommandTest, ACommandHasNoStandardInput) {
  const std::vector<Answer> answers =
      Ask("[\"convert\", \"-\", \"--input-format\", \"bvh\", \"--out\", \"-\", "
          "\"--output-format\", \"csv\"]\n[\"--version\"]\n");
  ASSERT_THAT(answers, SizeIs(2));
  EXPECT_NE(answers[0].exit_code, 0);
  EXPECT_EQ(answers[1].exit_code, 0);
}

TEST(StdioCommandTest, InvalidLineIsAUsageError) {
  for (const char* line : {"", "convert", "{", "[]", "{\"a\": 1}", "[1]", "[[\"models\"]]",
                           "[\"stdio\"]", "[\"\xff\"]"}) {
    const std::vector<Answer> answers = Ask(std::string(line) + "\n[\"--version\"]\n");
    ASSERT_THAT(answers, SizeIs(2)) << line;
    EXPECT_EQ(answers[0].exit_code, 2) << line;
    EXPECT_THAT(answers[0].err, HasSubstr("expected a JSON array with the words of a command"));
    EXPECT_EQ(answers[1].exit_code, 0) << line;
  }
}

TEST(StdioCommandTest, EmptyInputSucceeds) { EXPECT_THAT(Ask(""), SizeIs(0)); }

}  // namespace
}  // namespace duet::client::cli
