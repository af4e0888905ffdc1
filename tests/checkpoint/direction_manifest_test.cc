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
  static_cast<engine::AngleRegression&>(manifest.model.partner_direction.emplace()) = {
      Numbers(-0.3), Numbers(0.1), Numbers(-1), Numbers(0.2)};
  return manifest;
}

// With a correction, to which each of the manifest's classes adds something.
Manifest CorrectedManifest() {
  Manifest manifest = DirectedManifest();
  engine::DirectionCorrection& correction = manifest.model.partner_direction->correction.emplace();
  static_cast<engine::AngleRegression&>(correction) = {Numbers(0), Numbers(2), Numbers(3),
                                                       Numbers(4)};
  for (std::size_t c = 0; c < manifest.model.classes.size(); ++c) {
    const double first = static_cast<double>(c);
    correction.classes.push_back({Numbers(5 + first), Numbers(-first)});
  }
  return manifest;
}

TEST(DirectionManifest, CorrectionRoundTrip) {
  const std::string text = SerializeManifest(CorrectedManifest());
  const absl::StatusOr<Manifest> read = ParseManifest(text);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(SerializeManifest(*read), text);
  ASSERT_TRUE(read->model.partner_direction->correction.has_value());
  const engine::DirectionCorrection& correction = *read->model.partner_direction->correction;
  EXPECT_EQ(correction.mean, Numbers(0));
  EXPECT_EQ(correction.sine, Numbers(4));
  ASSERT_EQ(correction.classes.size(), read->model.classes.size());
  EXPECT_EQ(correction.classes[1].cosine, Numbers(6));
  EXPECT_EQ(correction.classes[1].sine, Numbers(-1));
}

TEST(DirectionManifest, RejectsACorrectionByName) {
  const auto refusal = [](const std::string& pointer, const json& value) {
    return ParseEdited(CorrectedManifest(), "/partner_direction/correction" + pointer, value);
  };
  EXPECT_THAT(refusal("", 1), IsInvalid("partner_direction.correction"));
  EXPECT_THAT(refusal("/mean", Numbers(1).front()), IsInvalid("partner_direction.correction.mean"));
  EXPECT_THAT(
      refusal("/classes", json::array()),
      IsInvalid("partner_direction.correction.classes: expected one object for each of the"));
  EXPECT_THAT(refusal("/classes/1", 3),
              IsInvalid("partner_direction.correction.classes: expected objects, got 3"));
  EXPECT_THAT(refusal("/classes/1/sine/2", "x"),
              IsInvalid("partner_direction.correction.classes[1].sine[2]: expected a number"));
  EXPECT_THAT(refusal("/classes/1/tangent", 1),
              IsInvalid("partner_direction.correction.classes[1]: unknown field \"tangent\""));
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
