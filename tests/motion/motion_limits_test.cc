#include "model/motion/motion_limits.h"

#include <limits>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

TEST(CheckFrameRate, AcceptsRatesOfCameras) {
  for (const double rate : {0.1, 15.0, 29.97, 1000.0}) {
    EXPECT_THAT(CheckFrameRate("a.csv", rate), IsOk()) << rate;
  }
  for (const double rate : {0.0, -30.0, 1000.1, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(CheckFrameRate("a.csv", rate),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         ::testing::StartsWith(
                             "a.csv: frame rate: expected more than 0 and at most 1000 Hz, got ")))
        << rate;
  }
}

TEST(ParseCoordinate, AcceptsNumbersWithinTheLimit) {
  float value = 0;
  EXPECT_TRUE(ParseCoordinate("-10000000", &value));
  EXPECT_EQ(value, -1e7f);
  EXPECT_TRUE(ParseCoordinate("+2.5", &value));
  EXPECT_EQ(value, 2.5f);
  for (const char* text : {"10000001", "-1e30", "nan", "x", ""}) {
    EXPECT_FALSE(ParseCoordinate(text, &value)) << text;
  }
  EXPECT_EQ(value, 2.5f) << "a refused text leaves the value as it was";
}

TEST(ExpectedCoordinate, NamesTheLimitOfANumberBeyondIt) {
  EXPECT_EQ(ExpectedCoordinate("-1e30"),
            "expected a finite number within +-10000000, got \"-1e30\"");
  for (const char* text : {"nan", "x", "1e999"}) {
    EXPECT_EQ(ExpectedCoordinate(text),
              absl::StrCat("expected a finite number, got \"", text, "\""));
  }
}

}  // namespace
}  // namespace duet::motion
