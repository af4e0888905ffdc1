#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "model/checkpoint/manifest.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::CompleteManifest;  // of a model with the classes kick and hug

using nlohmann::json;

TEST(TouchingClassesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  manifest.model.touching_classes = {"kick"};
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_THAT(read->model.touching_classes, ElementsAre("kick"));
}

TEST(TouchingClassesInManifest, EmptyListDiffersFromAnAbsentField) {
  const std::string text = SerializeManifest(CompleteManifest());
  const absl::StatusOr<Manifest> none = ParseManifest(text);
  ASSERT_THAT(none, IsOk());
  EXPECT_THAT(none->model.touching_classes, IsEmpty());
  json silent = json::parse(text);
  silent.erase("touching_classes");
  const absl::StatusOr<Manifest> earlier = ParseManifest(silent.dump());
  ASSERT_THAT(earlier, IsOk());
  EXPECT_THAT(earlier->model.touching_classes, ElementsAre("hug"));
  silent["classes"] = {"kick", "bow"};
  const absl::StatusOr<Manifest> without_hug = ParseManifest(silent.dump());
  ASSERT_THAT(without_hug, IsOk());
  EXPECT_THAT(without_hug->model.touching_classes, IsEmpty());
}

TEST(TouchingClassesInManifest, MustBeClasses) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  root["touching_classes"] = {"hug", "dance"};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("touching_classes: expected one of classes, got \"dance\"")));
  root["touching_classes"] = {"hug", "hug"};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("repeated")));
}

TEST(HandContactsInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  manifest.model.hand_contacts = {{"hug", 0.25}};
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->model.hand_contacts.size(), 1u);
  EXPECT_EQ(read->model.hand_contacts[0].interaction_class, "hug");
  EXPECT_EQ(read->model.hand_contacts[0].metres, 0.25);
  EXPECT_THAT(ParseManifest(SerializeManifest(CompleteManifest()))->model.hand_contacts, IsEmpty());
}

TEST(HandContactsInManifest, NamesAClassAndADistance) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  root["hand_contacts"] = {{"bow", 0.1}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("hand_contacts: expected one of classes, got \"bow\"")));
  root["hand_contacts"] = {{"hug", 3}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("hand_contacts.hug")));
}

TEST(TurningClassesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  manifest.model.turning_classes = {{"hug", 240}};
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->model.turning_classes.size(), 1u);
  EXPECT_EQ(read->model.turning_classes[0].interaction_class, "hug");
  EXPECT_EQ(read->model.turning_classes[0].degrees_per_second, 240);
  EXPECT_THAT(ParseManifest(SerializeManifest(CompleteManifest()))->model.turning_classes,
              IsEmpty());
}

TEST(TurningClassesInManifest, AreClassesWithASpeed) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  root["turning_classes"] = {{"spin", 240}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("turning_classes: expected one of classes, got \"spin\"")));
  root["turning_classes"] = {{"hug", -1}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("turning_classes.hug")));
}

TEST(FacingClassesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest))->model.facing_classes, IsEmpty());
  manifest.model.facing_classes = {{"hug", 64}};
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->model.facing_classes.size(), 1u);
  EXPECT_EQ(read->model.facing_classes[0].interaction_class, "hug");
  EXPECT_EQ(read->model.facing_classes[0].degrees, 64);
}

TEST(FacingClassesInManifest, AreClassesWithAnAngle) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  root["facing_classes"] = {{"walk", 60}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("facing_classes: expected one of classes, got \"walk\"")));
  root["facing_classes"] = {{"hug", 181}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("facing_classes.hug")));
}

TEST(StepsInTimeInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  EXPECT_FALSE(ParseManifest(SerializeManifest(manifest))->model.steps_in_time);
  manifest.model.steps_in_time = true;
  EXPECT_TRUE(ParseManifest(SerializeManifest(manifest))->model.steps_in_time);
  json root = json::parse(SerializeManifest(manifest));
  root["steps_in_time"] = 1;
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("steps_in_time")));
}

TEST(BodiesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest))->model.bone_ratios, IsEmpty());
  EXPECT_EQ(ParseManifest(SerializeManifest(manifest))->model.hip_height, 0);
  manifest.model.bone_ratios.assign(manifest.model.skeleton.bones.size(), 0.9);
  manifest.model.hip_height = 0.88;
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.bone_ratios, manifest.model.bone_ratios);
  EXPECT_EQ(read->model.hip_height, 0.88);
}

TEST(BodiesInManifest, HaveARatioForEachBone) {
  const auto error_of = [](const json& ratios) {
    json root = json::parse(SerializeManifest(CompleteManifest()));
    root["bone_ratios"] = ratios;
    return ParseManifest(root.dump()).status();
  };
  const std::size_t bones = CompleteManifest().model.skeleton.bones.size();
  json ratios = std::vector<double>(bones, 0.9);
  ASSERT_THAT(error_of(ratios), IsOk());
  ratios[1] = 0;
  EXPECT_THAT(error_of(ratios), StatusIs(absl::StatusCode::kInvalidArgument,
                                         HasSubstr("bone_ratios[1]: expected a number from 0.1")));
  ratios[1] = "long";
  EXPECT_THAT(error_of(ratios),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("got \"long\"")));
  EXPECT_THAT(error_of(std::vector<double>(bones - 1, 0.9)),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("(one for each bone), got")));
  EXPECT_THAT(error_of(std::vector<double>(bones + 1, 0.9)),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("bone_ratios")));
}

TEST(BodiesInManifest, HaveAHipHeightInLegs) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  root["hip_height"] = 1.2;
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("hip_height")));
}

TEST(LongestPosesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  EXPECT_EQ(ParseManifest(SerializeManifest(manifest))->model.longest_poses.astride, 0);
  manifest.model.longest_poses = {0.6, 1.2};
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.longest_poses.astride, 0.6);
  EXPECT_EQ(read->model.longest_poses.held_out, 1.2);
}

TEST(LongestPosesInManifest, AreSeconds) {
  for (const char* field : {"astride_seconds", "held_out_seconds"}) {
    json root = json::parse(SerializeManifest(CompleteManifest()));
    root[field] = 61;
    EXPECT_THAT(ParseManifest(root.dump()),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(field)));
  }
}

TEST(StrikesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  manifest.model.strikes = {{"hug", engine::StrikingLimb::kFist},
                            {"kick", engine::StrikingLimb::kFoot}};
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->model.strikes.size(), 2u);
  EXPECT_EQ(read->model.strikes[0].interaction_class, "hug");
  EXPECT_EQ(read->model.strikes[0].limb, engine::StrikingLimb::kFist);
  EXPECT_EQ(read->model.strikes[1].limb, engine::StrikingLimb::kFoot);
  EXPECT_THAT(ParseManifest(SerializeManifest(CompleteManifest()))->model.strikes, IsEmpty());
}

TEST(StrikesInManifest, NamesAClassAndALimb) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  root["strikes"] = {{"bow", "fist"}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("strikes: expected one of classes, got \"bow\"")));
  root["strikes"] = {{"kick", "knee"}};
  EXPECT_THAT(ParseManifest(root.dump()),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("strikes.kick: expected \"fist\" or \"foot\", got \"knee\"")));
}

}  // namespace
}  // namespace duet::checkpoint
