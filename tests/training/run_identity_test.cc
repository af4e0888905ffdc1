#include "model/training/run_identity.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::training {
namespace {

constexpr char kManifest[] =
    "{\n  \"name\": \"sbu\",\n  \"training\": {\n    \"epochs\": \"300\"\n  }\n}\n";

TEST(DescribeIdentityChange, NamesTheSettings) {
  const std::string saved =
      RunIdentity(kManifest, {{"epochs", "300"}, {"losses.bone", "0.01"}}, "sbu");
  EXPECT_EQ(DescribeIdentityChange(
                saved, RunIdentity(kManifest, {{"epochs", "200"}, {"losses.bone", "0.01"}}, "sbu")),
            "epochs: expected 300, got 200");
  EXPECT_EQ(
      DescribeIdentityChange(saved,
                             RunIdentity("{}\n", {{"losses.bone", "0"}, {"seed", "1"}}, "k3hi")),
      "epochs: expected 300, got none; losses.bone: expected 0.01, got 0; seed: expected none, "
      "got 1");
}

TEST(DescribeIdentityChange, CountsSettingsBeyondTheFirst) {
  std::map<std::string, std::string> before, after;
  for (char name = 'a'; name <= 'h'; ++name) {
    before[std::string(1, name)] = "0";
    after[std::string(1, name)] = "1";
  }
  EXPECT_THAT(DescribeIdentityChange(RunIdentity(kManifest, before, "sbu"),
                                     RunIdentity(kManifest, after, "sbu")),
              ::testing::EndsWith("e: expected 0, got 1; and 3 more"));
}

TEST(DescribeIdentityChange, TellsDataFromModel) {
  const std::string saved = RunIdentity(kManifest, {{"epochs", "300"}}, "sbu train 0,1");
  EXPECT_EQ(
      DescribeIdentityChange(saved, RunIdentity(kManifest, {{"epochs", "300"}}, "sbu train 0")),
      "the data: expected the same sequences, got others");
  EXPECT_THAT(
      DescribeIdentityChange(saved, RunIdentity("{}\n", {{"epochs", "300"}}, "sbu train 0,1")),
      ::testing::StartsWith("the model: "));
}

}  // namespace
}  // namespace duet::training
