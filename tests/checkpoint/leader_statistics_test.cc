#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "model/checkpoint/manifest.h"
#include "tests/checkpoint/edited_manifest.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::CompleteManifest;

using nlohmann::json;

Manifest ManifestWithLeaders() {
  Manifest manifest = CompleteManifest();
  manifest.model.leader_statistics = engine::LeaderStatistics{
      {{"root_height", 0.95, 1.0 / 3}, {"mean_joint_speed", -0.125, 0.5}}, 1.4};
  return manifest;
}

TEST(LeaderStatisticsInManifest, RoundTrip) {
  const std::string text = SerializeManifest(ManifestWithLeaders());
  const absl::StatusOr<Manifest> read = ParseManifest(text);
  ASSERT_THAT(read, IsOk());
  ASSERT_TRUE(read->model.leader_statistics.has_value());
  const engine::LeaderStatistics& leaders = *read->model.leader_statistics;
  ASSERT_EQ(leaders.features.size(), 2u);
  EXPECT_EQ(leaders.features[0].name, "root_height");
  EXPECT_EQ(leaders.features[0].mean, 0.95);
  EXPECT_EQ(leaders.features[0].deviation, 1.0 / 3);
  EXPECT_EQ(leaders.features[1].name, "mean_joint_speed");
  EXPECT_EQ(leaders.features[1].mean, -0.125);
  EXPECT_EQ(leaders.scale, 1.4);
  EXPECT_EQ(SerializeManifest(*read), text);
}

TEST(LeaderStatisticsInManifest, MayBeAbsent) {
  Manifest manifest = ManifestWithLeaders();
  manifest.model.leader_statistics.reset();
  const std::string text = SerializeManifest(manifest);
  EXPECT_FALSE(json::parse(text).contains("leader_statistics"));
  const absl::StatusOr<Manifest> read = ParseManifest(text);
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->model.leader_statistics.has_value());
}

TEST(LeaderStatisticsInManifest, SamplingGeneratorHasThemToo) {
  Manifest manifest = ManifestWithLeaders();
  manifest.architecture = test::SmallFlow();
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_TRUE(read->model.leader_statistics.has_value());
}

TEST(LeaderStatisticsInManifest, RejectsByName) {
  const auto refusal = [](const std::string& pointer, const json& value) {
    return ParseEdited(ManifestWithLeaders(), pointer, value);
  };
  EXPECT_THAT(refusal("/leader_statistics", 3),
              IsInvalid("leader_statistics: expected an object, got 3"));
  EXPECT_THAT(refusal("/leader_statistics/scale", 0),
              IsInvalid("leader_statistics.scale: expected"));
  EXPECT_THAT(refusal("/leader_statistics/more", 0),
              IsInvalid("leader_statistics: unknown field \"more\""));
  EXPECT_THAT(refusal("/leader_statistics/features", json::array()),
              IsInvalid("leader_statistics.features: expected at least one feature, got none"));
  EXPECT_THAT(refusal("/leader_statistics/features/1", 7),
              IsInvalid("leader_statistics.features[1]: expected an object, got 7"));
  EXPECT_THAT(refusal("/leader_statistics/features/1/deviation", 0),
              IsInvalid("leader_statistics.features[1].deviation: expected"));
  EXPECT_THAT(refusal("/leader_statistics/features/0/mean", "much"),
              IsInvalid("leader_statistics.features[0].mean: expected"));
  EXPECT_THAT(refusal("/leader_statistics/features/0/median", 1),
              IsInvalid("leader_statistics.features[0]: unknown field \"median\""));
  EXPECT_THAT(refusal("/leader_statistics/features/1/name", "root_height"),
              IsInvalid("leader_statistics.features[1].name: \"root_height\" is repeated"));
}

// Version 1 had none: a reader of only that version would reject them.
TEST(LeaderStatisticsInManifest, AreRejectedInVersionOne) {
  Manifest manifest = ManifestWithLeaders();
  manifest.format_version = 1;
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest)),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("leader_statistics")));
}

// The tiny skeleton has no hands.
TEST(LeaderStatisticsInManifest, RequiresFeaturesOfTheSkeleton) {
  json root = json::parse(SerializeManifest(ManifestWithLeaders()));
  root["leader_statistics"]["features"][0]["name"] = "hand_reach";
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("leader_statistics.features[0].name: expected one of "
                                 "mean_joint_speed, highest_joint_speed")));
}

}  // namespace
}  // namespace duet::checkpoint
