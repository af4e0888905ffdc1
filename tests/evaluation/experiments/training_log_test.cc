#include "model/evaluation/experiments/training_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/status_matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::IsOk;
using test::StatusIs;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::NanSensitiveDoubleEq;

TEST(TrainingLogTest, ReadsColumnsByName) {
  const auto log = ParseTrainingLog(
      "epoch,bone,validation_afd,adversarial\n1,0.5,,nan\n2,0.25,0.4,nan\n4,,0.5,nan\n", "log.csv");
  ASSERT_THAT(log, IsOk());
  EXPECT_THAT(log->epochs, ElementsAre(1, 2, 4));
  ASSERT_NE(log->Find("bone"), nullptr);
  EXPECT_THAT(*log->Find("bone"), ElementsAre(0.5, 0.25, NanSensitiveDoubleEq(std::nan(""))));
  ASSERT_NE(log->Find("validation_afd"), nullptr);
  EXPECT_TRUE(std::isnan((*log->Find("validation_afd"))[0]));
  EXPECT_EQ(log->Find("adversarial"), nullptr) << "a column without any figure";
  EXPECT_EQ(log->Find("continuity"), nullptr);
}

std::string ProblemWith(const std::string& text) {
  const auto log = ParseTrainingLog(text, "log.csv");
  EXPECT_THAT(log, StatusIs(absl::StatusCode::kInvalidArgument, testing::_)) << text;
  return std::string(log.status().message());
}

TEST(TrainingLogTest, SaysWhereAndWhatIsWrong) {
  EXPECT_THAT(ProblemWith(""), HasSubstr("log.csv:1: empty"));
  EXPECT_THAT(ProblemWith("bone,generator\n1,2\n"), HasSubstr("wanted `epoch`"));
  EXPECT_THAT(ProblemWith("epoch,bone,bone\n"), HasSubstr("\"bone\" is repeated"));
  EXPECT_THAT(ProblemWith("epoch,,bone\n"), HasSubstr("log.csv:1: a column without a name"));
  EXPECT_THAT(ProblemWith("epoch,bone\n"), HasSubstr("no epoch"));
  EXPECT_THAT(ProblemWith("epoch,bone\n1,2\n2\n"), HasSubstr("log.csv:3: 1 fields came, wanted 2"));
  EXPECT_THAT(ProblemWith("epoch,bone\n1,much\n"), HasSubstr("log.csv:2: bone: came \"much\""));
  EXPECT_THAT(ProblemWith("epoch,bone\n1,2\n1,3\n"), HasSubstr("log.csv:3: epoch: came 1"));
  EXPECT_THAT(ProblemWith("epoch,bone\n,2\n"), HasSubstr("log.csv:2: epoch: came nan"));
}

}  // namespace
}  // namespace duet::evaluation::experiments
