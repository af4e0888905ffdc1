#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "model/checkpoint/manifest.h"
#include "tests/checkpoint/edited_manifest.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::CompleteManifest;

using nlohmann::json;

// Three joints: 2 (3 + 1) + 1 features.
std::vector<double> Numbers(double first) {
  std::vector<double> numbers;
  for (int i = 0; i < 9; ++i) numbers.push_back(first + i / 7.0);
  return numbers;
}

Manifest DirectedManifest() {
  Manifest manifest = CompleteManifest();
  manifest.model.partner_direction = {Numbers(-0.3), Numbers(0.1), Numbers(-1), Numbers(0.2)};
  return manifest;
}

TEST(DirectionManifest, RoundTrip) {
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(DirectedManifest()));
  ASSERT_THAT(read, IsOk());
  ASSERT_TRUE(read->model.partner_direction.has_value());
  EXPECT_EQ(read->model.partner_direction->mean, Numbers(-0.3));
  EXPECT_EQ(read->model.partner_direction->deviation, Numbers(0.1));
  EXPECT_EQ(read->model.partner_direction->cosine, Numbers(-1));
  EXPECT_EQ(read->model.partner_direction->sine, Numbers(0.2));
}

TEST(DirectionManifest, MayBeAbsent) {
  Manifest manifest = DirectedManifest();
  manifest.model.partner_direction.reset();
  const std::string text = SerializeManifest(manifest);
  EXPECT_THAT(text, Not(HasSubstr("partner_direction")));
  const absl::StatusOr<Manifest> read = ParseManifest(text);
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->model.partner_direction.has_value());
  EXPECT_EQ(SerializeManifest(*read), text);
}

TEST(DirectionManifest, RejectsByName) {
  const auto refusal = [](const std::string& pointer, const json& value) {
    return ParseEdited(DirectedManifest(), pointer, value);
  };
  std::vector<double> few = Numbers(1), many = Numbers(1);
  few.pop_back();
  many.push_back(1);
  EXPECT_THAT(
      refusal("/partner_direction/mean", few),
      IsInvalid(
          "partner_direction.mean: expected 9 numbers (two for each joint, three more), got 8"));
  EXPECT_THAT(refusal("/partner_direction/sine", many), IsInvalid("partner_direction.sine"));
  EXPECT_THAT(refusal("/partner_direction/deviation/3", 0),
              IsInvalid("partner_direction.deviation[3]: expected a number"));
  EXPECT_THAT(refusal("/partner_direction/cosine/0", "x"),
              IsInvalid("partner_direction.cosine[0]: expected a number"));
  EXPECT_THAT(refusal("/partner_direction/cosine/8", 1e9),
              IsInvalid("partner_direction.cosine[8]"));
  EXPECT_THAT(refusal("/partner_direction/tangent", few),
              IsInvalid("partner_direction: unknown field \"tangent\""));
  EXPECT_THAT(refusal("/partner_direction", json::object()), IsInvalid("partner_direction.mean"));
  EXPECT_THAT(refusal("/partner_direction", 1), IsInvalid("partner_direction"));
}

TEST(DirectionManifest, NeedsHips) {
  json root = json::parse(SerializeManifest(DirectedManifest()));
  root["skeleton"].erase("left_hip");
  root["skeleton"].erase("right_hip");
  EXPECT_THAT(ParseManifest(root.dump()), StatusIs(absl::StatusCode::kInvalidArgument,
                                                   HasSubstr("partner_direction: expected none")));
  root.erase("partner_direction");
  EXPECT_THAT(ParseManifest(root.dump()), IsOk());
}

}  // namespace
}  // namespace duet::checkpoint
