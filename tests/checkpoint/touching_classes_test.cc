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

TEST(BodiesInManifest, RoundTrip) {
  Manifest manifest = CompleteManifest();
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest))->model.bone_ratios, IsEmpty());
  manifest.model.bone_ratios.assign(manifest.model.skeleton.bones.size(), 0.9);
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.bone_ratios, manifest.model.bone_ratios);
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

// Checkpoints of earlier versions have fields of stages that are gone.
TEST(FormerFieldsInManifest, AreReadAndNotWrittenAgain) {
  json root = json::parse(SerializeManifest(CompleteManifest()));
  const json former = {{"turning_classes", {{"hug", 240}}},
                       {"steps_in_time", true},
                       {"hip_height", 0.88},
                       {"astride_seconds", 0.6},
                       {"held_out_seconds", 1.2},
                       {"strikes", {{"hug", "fist"}}}};
  root.update(former);
  const absl::StatusOr<Manifest> read = ParseManifest(root.dump());
  ASSERT_THAT(read, IsOk());
  const json again = json::parse(SerializeManifest(*read));
  for (const auto& field : former.items()) EXPECT_FALSE(again.contains(field.key()));
}

}  // namespace
}  // namespace duet::checkpoint
