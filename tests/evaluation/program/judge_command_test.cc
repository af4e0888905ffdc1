#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/evaluation/support/made_up_captures.h"
#include "tests/evaluation/support/run_command.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::program {
namespace {

// Four clips of each class. Followers stand at a distance of their class.
void WriteCaptures(const dataset::CaptureFolder& folder) {
  float away = 0;
  for (const char* interaction_class : test::kSbuClassFolders) {
    away += 0.6f;
    for (int clip = 1; clip <= 4; ++clip) {
      std::string text;
      for (int t = 0; t < 20; ++t) {
        const double seconds = (1 + 0.1 * clip) * t / 15;
        text += dataset::CaptureLine(
            t + 1, test::AsCaptured(test::SwayingPose(seconds), {-1, 0, 0}),
            test::AsCaptured(test::SwayingPose(2 * seconds), {away - 1, 0, 0}));
      }
      folder.Write("s01s02/" + std::string(interaction_class) + "/00" + std::to_string(clip) +
                       "/skeleton_pos.txt",
                   text);
    }
  }
}

class JudgeCommandTest : public ::testing::Test {
 protected:
  absl::Status Run(std::vector<std::string> words) {
    WriteCaptures(captures_);
    words.insert(words.begin(), {"judge", "--data", captures_.path().string()});
    ::testing::internal::CaptureStdout();
    absl::Status status = test::RunCommand(AddJudgeCommand, std::move(words));
    out_ = ::testing::internal::GetCapturedStdout();
    return status;
  }

  dataset::CaptureFolder captures_;
  std::string out_;
};

TEST_F(JudgeCommandTest, PartsTellWhetherClassesCanBeToldApart) {
  ASSERT_THAT(Run({"--parts", "2", "--epochs", "30"}), IsOk());
  EXPECT_THAT(out_,
              AllOf(HasSubstr("kick: 4 of 4 recognised\n"), HasSubstr("punch: 4 of 4 recognised\n"),
                    HasSubstr(" % of the held-out followers classified correctly\n")));
}

TEST_F(JudgeCommandTest, PartsTellWhatTheOthersAreTakenFor) {
  // An untrained judge takes everything for one class.
  ASSERT_THAT(Run({"--parts", "4", "--epochs", "0"}), IsOk());
  EXPECT_THAT(out_, ContainsRegex("kick: [0-4] of 4 recognised; [1-4] taken for [a-z_]+"));
  EXPECT_THAT(out_, Not(HasSubstr("100.0 %")));
}

}  // namespace
}  // namespace duet::evaluation::program
