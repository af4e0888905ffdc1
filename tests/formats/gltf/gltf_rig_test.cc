#include <algorithm>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_motion.h"
#include "nlohmann/json.hpp"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::gltf {
namespace {

absl::StatusOr<std::string> NoFile(const std::string& name) { return absl::NotFoundError(name); }

motion::Clip Follower() {
  test::PersonOptions options;
  options.frames = 60;
  options.yaw = 2;
  options.turn = 3;
  options.at = {0.5f, 1.1f, -1};
  return test::MakePerson(options);
}

std::string OntoRig(const std::string& rig, GltfContainer container = GltfContainer::kBinary) {
  const absl::StatusOr<std::string> written =
      OntoGltfRig(Follower(), rig, "rig.glb", NoFile, {}, container);
  EXPECT_THAT(written.status(), IsOk());
  return written.value_or("");
}

// How far feet and hands are from where they should be, metres.
double Error(const std::string& content) {
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, "written");
  EXPECT_THAT(document.status(), IsOk());
  GltfImportOptions options;
  options.frame_rate_hz = 30;
  const absl::StatusOr<motion::Clip> read = FromGltf(*document, "written", NoFile, options);
  EXPECT_THAT(read.status(), IsOk());
  const motion::Clip clip = Follower();
  EXPECT_EQ(read->frame_count(), clip.frame_count());
  double largest = 0;
  for (const char* name : {"left_foot", "right_foot", "left_hand", "right_hand"}) {
    const int joint = motion::SbuSkeleton().Find(name);
    for (int frame = 0; frame < std::min(read->frame_count(), clip.frame_count()); ++frame) {
      largest = std::max(
          largest, static_cast<double>(Distance(read->at(frame, joint), clip.at(frame, joint))));
    }
  }
  return largest;
}

// Another person's rig of the same build, as Blender writes one from Mixamo: below a node that
// turns and scales it, bones in centimetres.
std::string BlendersRig(bool centimetres) {
  test::GltfBuilder builder;
  test::GltfPersonOptions options;
  options.centimetres_below_an_armature = centimetres;
  test::AddPerson(test::MakePerson(), options, &builder);
  return builder.Binary();
}

TEST(OntoGltfRig, TheFollowerStandsAndReachesOnTheRig) {
  EXPECT_LT(Error(OntoRig(BlendersRig(false))), 0.005);
  EXPECT_LT(Error(OntoRig(BlendersRig(true))), 0.005);
  EXPECT_LT(Error(OntoRig(BlendersRig(false), GltfContainer::kText)), 0.005);
}

TEST(OntoGltfRig, KeepsEverythingExceptAnimations) {
  test::GltfBuilder builder;
  test::AddPerson(test::MakePerson(), {}, &builder);
  builder.json()["extras"] = {{"note", "mine"}};
  const nlohmann::json before = builder.json();
  const nlohmann::json after =
      nlohmann::json::parse(OntoRig(builder.Binary(), GltfContainer::kText));
  EXPECT_EQ(after["extras"]["note"], "mine");
  EXPECT_EQ(after["skins"], before["skins"]);
  ASSERT_EQ(after["nodes"].size(), before["nodes"].size());
  for (std::size_t i = 0; i < before["nodes"].size(); ++i) {
    EXPECT_EQ(after["nodes"][i]["name"], before["nodes"][i]["name"]);
  }
  ASSERT_EQ(after["animations"].size(), 1u);
  EXPECT_EQ(after["animations"][0]["name"], "duet");
  EXPECT_EQ(after["buffers"].size(), 1u);
}

// A character with a mesh of 4 vertices, and an animation of `frames` frames.
test::GltfBuilder CharacterWithMesh(int frames) {
  test::GltfBuilder builder;
  test::PersonOptions person;
  person.frames = frames;
  test::AddPerson(test::MakePerson(person), {}, &builder);
  const int positions = builder.AddAccessor({0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, "VEC3");
  builder.json()["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
  return builder;
}

TEST(OntoGltfRig, KeepsTheDataOfMeshesAndSkins) {
  test::GltfBuilder builder = CharacterWithMesh(30);
  const std::string before = builder.buffer();
  const std::string text = OntoRig(builder.Binary(), GltfContainer::kText);
  const nlohmann::json after = nlohmann::json::parse(text);
  const nlohmann::json& accessor =
      after["accessors"]
           [after["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(accessor["count"], 4);
  const nlohmann::json& view = after["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const absl::StatusOr<GltfDocument> document = ParseGltf(text, "written");
  ASSERT_THAT(document.status(), IsOk());
  GltfBuffers buffers(*document, NoFile);
  const absl::StatusOr<const std::string*> bytes = buffers.Whole(0);
  ASSERT_THAT(bytes.status(), IsOk());
  const std::size_t begin =
      view["byteOffset"].get<std::size_t>() + accessor.value("byteOffset", 0u);
  EXPECT_EQ((*bytes)->substr(begin, 48), before.substr(before.size() - 48));
}

TEST(OntoGltfRig, AcceptsACharacterWithoutAnimation) {
  test::GltfBuilder builder;
  test::AddPerson(test::MakePerson(), {}, &builder);
  builder.json().erase("animations");
  EXPECT_LT(Error(OntoRig(builder.Binary())), 0.005);
}

}  // namespace
}  // namespace duet::formats::gltf
