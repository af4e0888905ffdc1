#include "model/training/options.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/matchers.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

std::string DefaultJson() { return std::string(FindConfig("default")->json); }
std::string FlowJson() { return std::string(FindConfig("flow")->json); }

TEST(TrainingOptionsTest, EveryNamedConfigurationParses) {
  ASSERT_FALSE(NamedConfigs().empty());
  for (const NamedConfig& config : NamedConfigs()) {
    EXPECT_THAT(ParseConfig(config.json), IsOk()) << config.name;
  }
}

TEST(TrainingOptionsTest, ReplacementsReachTheirField) {
  const auto options = ParseConfig(
      DefaultJson(), {{"losses.bone", "0.25"}, {"optimiser.name", "rmsprop"}, {"epochs", "7"}});
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(std::get<PaperTraining>(options->method).losses.bone, 0.25);
  EXPECT_EQ(options->optimiser.name, "rmsprop");
  EXPECT_EQ(options->epochs, 7);
  EXPECT_EQ(Describe(*options).at("losses.bone"), "0.25");
}

// A state is only valid for exactly equal settings.
TEST(TrainingOptionsTest, SettingsAreDescribedToTheLastDigit) {
  TrainingOptions options;
  options.optimiser.learning_rate = 0.0010000001;
  EXPECT_EQ(Describe(options).at("optimiser.learning_rate"), "0.0010000001");
  std::get<PaperTraining>(options.method).losses.bone = 1.0 / 3;
  EXPECT_EQ(std::stod(Describe(options).at("losses.bone")), 1.0 / 3);
  EXPECT_EQ(Describe(options).at("augmentation.crop"), "0");
}

TEST(TrainingOptionsTest, EverySettingIsRequiredAndDescribed) {
  const auto options = ParseConfig(DefaultJson());
  ASSERT_THAT(options, IsOk());
  for (const auto& [path, value] : Describe(*options)) {
    EXPECT_THAT(ParseConfig(DefaultJson(), {{path, "{}"}}), Not(IsOk())) << path;
  }
}

TEST(TrainingOptionsTest, EverySettingOfAFlowIsRequiredAndDescribed) {
  const auto options = ParseConfig(FlowJson());
  ASSERT_THAT(options, IsOk());
  ASSERT_TRUE(std::holds_alternative<FlowTraining>(options->method));
  const auto described = Describe(*options);
  EXPECT_EQ(described.at("flow.several_known"), "0.4");
  EXPECT_EQ(described.at("optimiser.warm_up_steps"), "100");
  EXPECT_EQ(described.count("losses.bone"), 0u);
  for (const auto& [path, value] : described) {
    EXPECT_THAT(ParseConfig(FlowJson(), {{path, "{}"}}), Not(IsOk())) << path;
  }
}

TEST(TrainingOptionsTest, InvalidFlowSettingsAreRejectedByName) {
  const auto refusal = [](const std::string& path, const std::string& value) {
    return std::string(ParseConfig(FlowJson(), {{path, value}}).status().message());
  };
  EXPECT_THAT(refusal("generator.kind", "wave"),
              HasSubstr("generator.kind: expected \"paper\" or \"flow\", got \"wave\""));
  EXPECT_THAT(refusal("generator.kind", "paper"), HasSubstr("generator.variant"));
  EXPECT_THAT(refusal("generator.heads", "7"), HasSubstr("generator.heads: expected a divisor"));
  EXPECT_THAT(refusal("generator.noise.white", "-1"), HasSubstr("generator.noise.white"));
  EXPECT_THAT(refusal("flow.unlabelled", "2"), HasSubstr("flow.unlabelled"));
  EXPECT_THAT(refusal("leaders.share", "0.05"), HasSubstr("leaders.share"));
  EXPECT_THAT(refusal("stillness.ends", "2"), HasSubstr("stillness.ends"));
  EXPECT_THAT(refusal("optimiser.schedule", "constant"),
              HasSubstr("optimiser: unknown field \"last_share\""));
  const auto tuned = ParseConfig(FlowJson(), {{"generator.steps", "5"}});
  ASSERT_THAT(tuned, IsOk());
  EXPECT_EQ(std::get<FlowTraining>(tuned->method).architecture.steps, 5);
}

TEST(TrainingOptionsTest, ConfigurationsOfVersionOneAreRead) {
  nlohmann::json old = nlohmann::json::parse(FlowJson());
  old.erase("leaders");
  old.erase("stillness");
  const auto options = ParseConfig(old.dump());
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(Describe(*options).at("leaders.share"), "0");
  EXPECT_EQ(Describe(*options).at("stillness.pauses"), "0");
}

TEST(TrainingOptionsTest, DerivedConfigurationChangesItsBase) {
  const auto options = ParseConfig(
      R"({"base": "default", "set": {"losses.bone": 0.5, "epochs": 3}})", {{"epochs", "4"}});
  ASSERT_THAT(options, IsOk());
  auto expected = Describe(*ParseConfig(DefaultJson()));
  expected["losses.bone"] = "0.5";
  expected["epochs"] = "4";
  EXPECT_EQ(Describe(*options), expected);
}

TEST(TrainingOptionsTest, DerivedConfigurationIsCheckedByName) {
  const auto refusal = [](const std::string& json) {
    return std::string(ParseConfig(json).status().message());
  };
  EXPECT_THAT(refusal(R"({"base": "nothing", "set": {}})"),
              HasSubstr("base: expected a named configuration, got \"nothing\""));
  EXPECT_THAT(refusal(R"({"base": "default"})"), HasSubstr("set"));
  EXPECT_THAT(refusal(R"({"base": "default", "set": {"losses.none": 1}})"),
              HasSubstr("losses.none: no such setting"));
  EXPECT_THAT(refusal(R"({"base": "default", "set": {}, "more": 1})"), HasSubstr("more"));
}

TEST(TrainingOptionsTest, HeldOutSubjectsMustExist) {
  const dataset::Dataset dataset = MadeUpDataset();
  TrainingOptions options;
  options.validation.subjects = {"s02"};
  EXPECT_THAT(CheckAgainst(options, dataset), IsOk());
  options.validation.subjects = {"s09"};
  EXPECT_THAT(
      CheckAgainst(options, dataset),
      StatusIs(
          absl::StatusCode::kInvalidArgument,
          HasSubstr("validation.subjects: expected subjects of the data (s01, s02), got \"s09\"")));
}

TEST(TrainingOptionsTest, MirroringRequiresLeftAndRightInJointNames) {
  dataset::Dataset dataset = MadeUpDataset();
  for (std::string& name : dataset.skeleton.joint_names) {
    name = "joint" + std::to_string(&name - dataset.skeleton.joint_names.data());
  }
  TrainingOptions options;
  EXPECT_THAT(CheckAgainst(options, dataset), IsOk());
  options.augmentation.mirror = 0.5;
  EXPECT_THAT(CheckAgainst(options, dataset),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("says left or right")));
  dataset.skeleton.joint_names[5] = "LeftWrist";
  dataset.skeleton.joint_names[8] = "RightWrist";
  EXPECT_THAT(CheckAgainst(options, dataset), IsOk());
}

}  // namespace
}  // namespace duet::training
