#include "model/training/options.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
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

TEST(TrainingOptionsTest, ConfigurationsBesideDataSetsParse) {
  const char* source = std::getenv("DUET_SOURCE_DIR");
  ASSERT_NE(source, nullptr) << "DUET_SOURCE_DIR is not set";
  for (const char* data : {"everyday", "salsa"}) {
    for (const char* run : {"first", "second", "third"}) {
      const auto file = std::filesystem::path(source) / "contrib" / data / "configs" / run;
      std::ifstream in(file.string() + ".json");
      EXPECT_THAT(ParseConfig(std::string(std::istreambuf_iterator<char>(in), {})), IsOk()) << file;
    }
  }
}

TEST(TrainingOptionsTest, ReplacementsReachTheirField) {
  const auto options = ParseConfig(
      DefaultJson(), {{"losses.bone", "0.25"}, {"optimiser.name", "rmsprop"}, {"epochs", "7"}});
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(options->paper.losses().bone(), 0.25);
  EXPECT_EQ(options->common.optimiser().name(), CommonSettings::Optimiser::RMSPROP);
  EXPECT_EQ(options->common.epochs(), 7);
  EXPECT_EQ(Describe(*options).at("optimiser.name"), "rmsprop");
  EXPECT_EQ(Describe(*options).at("losses.bone"), "0.25");
}

// A state is only valid for exactly equal settings.
TEST(TrainingOptionsTest, SettingsAreDescribedToTheLastDigit) {
  TrainingOptions options;
  options.common.mutable_optimiser()->set_learning_rate(0.0010000001);
  EXPECT_EQ(Describe(options).at("optimiser.learning_rate"), "0.0010000001");
  options.paper.mutable_losses()->set_bone(1.0 / 3);
  EXPECT_EQ(std::stod(Describe(options).at("losses.bone")), 1.0 / 3);
  EXPECT_EQ(Describe(options).at("augmentation.crop"), "0");
  options.common.set_seed(uint64_t{1} << 62);
  EXPECT_EQ(Describe(options).at("seed"), "4611686018427387904");
}

TEST(TrainingOptionsTest, EverySettingIsReadAndDescribed) {
  const auto options = ParseConfig(DefaultJson());
  ASSERT_THAT(options, IsOk());
  for (const auto& [path, value] : Describe(*options)) {
    EXPECT_THAT(ParseConfig(DefaultJson(), {{path, "{}"}}), Not(IsOk())) << path;
  }
}

TEST(TrainingOptionsTest, EverySettingOfAFlowIsReadAndDescribed) {
  const auto options = ParseConfig(FlowJson());
  ASSERT_THAT(options, IsOk());
  ASSERT_TRUE(std::holds_alternative<checkpoint::FlowArchitecture>(options->architecture));
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
              HasSubstr("optimiser: unknown field \"second_moment\""));
  const auto tuned = ParseConfig(FlowJson(), {{"generator.steps", "5"}});
  ASSERT_THAT(tuned, IsOk());
  EXPECT_EQ(std::get<checkpoint::FlowArchitecture>(tuned->architecture).steps, 5);
}

TEST(TrainingOptionsTest, AbsentSettingsHaveTheirDefaults) {
  nlohmann::json config = nlohmann::json::parse(FlowJson());
  config.erase("start");
  config["drift"] = {{"tilt", 0.1}};
  const auto options = ParseConfig(config.dump());
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(options->common.start().pose(), 0);
  EXPECT_EQ(Describe(*options).at("drift.tilt"), "0.1");
  EXPECT_EQ(Describe(*options).at("drift.turn"), "0.4");
  EXPECT_EQ(Describe(*options).at("leaders.share"), "0");
}

TEST(TrainingOptionsTest, SettingsWithoutADefaultAreRequired) {
  for (const char* name : {"generator", "standardisation", "epochs", "losses", "graded_labels"}) {
    nlohmann::json config = nlohmann::json::parse(DefaultJson());
    config.erase(name);
    EXPECT_THAT(std::string(ParseConfig(config.dump()).status().message()), HasSubstr(name));
  }
}

TEST(TrainingOptionsTest, InvalidSettingsAreRejectedByName) {
  const auto refusal = [](const std::string& path, const std::string& value) {
    return std::string(ParseConfig(DefaultJson(), {{path, value}}).status().message());
  };
  EXPECT_EQ(refusal("losses.bone", "-1"), "losses.bone: expected a number from 0 to 1e+06, got -1");
  EXPECT_EQ(refusal("optimiser.average_decay", "1"),
            "optimiser.average_decay: expected a number from 0 to 0.999999, got 1");
  EXPECT_EQ(refusal("start.root", "1.5"), "start.root: expected a number from 0 to 1, got 1.5");
  EXPECT_EQ(refusal("epochs", "0"), "epochs: expected a whole number from 1 to 1000000, got 0");
  EXPECT_EQ(refusal("seed", "-1"),
            "seed: expected a whole number from 0 to 9223372036854775807, got -1");
  EXPECT_EQ(refusal("optimiser.name", "sgd"),
            "optimiser.name: expected one of adam, rmsprop, got \"sgd\"");
  EXPECT_EQ(refusal("discriminator.binary", "1"),
            "discriminator.binary: expected true or false, got 1");
  EXPECT_EQ(refusal("losses.none", "1"), "losses: unknown field \"none\"");
  EXPECT_EQ(refusal("flow.passes", "1"), "unknown field \"flow\"");
  EXPECT_EQ(refusal("epochs.more", "1"), "epochs.more: no such setting");
  EXPECT_EQ(refusal("optimiser.last_share", "0"), "optimiser: unknown field \"last_share\"");
  EXPECT_EQ(refusal("augmentation", "1"), "augmentation: expected an object, got 1");
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
              HasSubstr("losses: unknown field \"none\""));
  EXPECT_THAT(refusal(R"({"base": "default", "set": {}, "more": 1})"), HasSubstr("more"));
}

TEST(TrainingOptionsTest, HeldOutSubjectsMustExist) {
  const dataset::Dataset dataset = MadeUpDataset();
  TrainingOptions options;
  options.common.mutable_validation()->add_subjects("s02");
  EXPECT_THAT(CheckAgainst(options, dataset), IsOk());
  options.common.mutable_validation()->set_subjects(0, "s09");
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
  options.common.mutable_augmentation()->set_mirror(0.5);
  EXPECT_THAT(CheckAgainst(options, dataset),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("says left or right")));
  dataset.skeleton.joint_names[5] = "LeftWrist";
  dataset.skeleton.joint_names[8] = "RightWrist";
  EXPECT_THAT(CheckAgainst(options, dataset), IsOk());
}

}  // namespace
}  // namespace duet::training
