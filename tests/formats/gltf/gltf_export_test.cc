#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_motion.h"
#include "nlohmann/json.hpp"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::gltf {
namespace {

using test::LargestDistance;
using test::MakePerson;
using test::PersonOptions;

constexpr float kRounding = 2e-5f;

motion::Clip Person(float x, double yaw) {
  PersonOptions options;
  options.at.x = x;
  options.yaw = yaw;
  options.turn = 4;
  return MakePerson(options);
}

std::string Format(const std::vector<motion::Clip>& people,
                   GltfContainer container = GltfContainer::kBinary) {
  return FormatGltf(people, motion::SbuSkeleton(), nullptr, container);
}

absl::StatusOr<std::string> NoFile(const std::string& name) { return absl::NotFoundError(name); }

motion::Clip ReadBack(const std::string& content, int person) {
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, "written");
  EXPECT_THAT(document.status(), IsOk());
  GltfImportOptions options;
  options.person = person;
  absl::StatusOr<motion::Clip> clip = FromGltf(*document, "written", NoFile, options);
  EXPECT_THAT(clip.status(), IsOk());
  return clip.value_or(motion::Clip());
}

// The JSON of a .gltf.
nlohmann::json Json(const std::vector<motion::Clip>& people,
                    const motion::Provenance* provenance = nullptr) {
  return nlohmann::json::parse(
      FormatGltf(people, motion::SbuSkeleton(), provenance, GltfContainer::kText));
}

TEST(GltfExport, KeepsThePositionsOfBothPeople) {
  const motion::Clip leader = Person(0, 1), follower = Person(1.2f, 4);
  for (const GltfContainer container : {GltfContainer::kBinary, GltfContainer::kText}) {
    const std::string content = Format({leader, follower}, container);
    EXPECT_LT(LargestDistance(ReadBack(content, 0), leader), kRounding);
    EXPECT_LT(LargestDistance(ReadBack(content, 1), follower), kRounding);
  }
}

TEST(GltfExport, KeepsJointPositionsIfBoneLengthsVary) {
  motion::Clip clip = Person(0, 1);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    for (int joint = 0; joint < clip.joint_count(); ++joint) {
      clip.at(frame, joint).y += 0.03f * std::sin(static_cast<float>(frame * (joint + 1)));
    }
  }
  EXPECT_LT(LargestDistance(ReadBack(Format({clip}), 0), clip), kRounding);
}

TEST(GltfExport, KeepsARateThatKeysDoNotDetermine) {
  motion::Clip clip = Person(0, 0);
  clip.frame_rate_hz = 29.97;
  EXPECT_EQ(ReadBack(Format({clip}), 0).frame_rate_hz, 29.97);
}

TEST(GltfExport, EachPersonHasASkeletonAndAMannequinOfTheirOwn) {
  const nlohmann::json json = Json({Person(0, 0), Person(1, 3)});
  std::map<std::string, int> nodes;
  for (const auto& node : json["nodes"]) ++nodes[node["name"]];
  EXPECT_EQ(nodes["leader"] + nodes["follower"], 2);
  EXPECT_EQ(nodes["leader_mannequin"] + nodes["follower_mannequin"], 2);
  EXPECT_EQ(nodes["left_elbow"], 2);
  ASSERT_EQ(json["skins"].size(), 2u);
  EXPECT_NE(json["skins"][0]["joints"], json["skins"][1]["joints"]);
  EXPECT_EQ(json["animations"].size(), 1u);
  EXPECT_THAT(json["materials"][0]["name"], "leader");
  EXPECT_NE(json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"],
            json["materials"][2]["pbrMetallicRoughness"]["baseColorFactor"]);
  EXPECT_EQ(Json({Person(0, 0)})["nodes"][0]["name"], "person");
}

// A vertex of the mannequin, taken along by its joint's bind matrix, is where it was at rest.
TEST(GltfExport, BindMatricesUndoTheRestPose) {
  const std::string content = Format({Person(0, 0)});
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, "written");
  ASSERT_THAT(document.status(), IsOk());
  const GltfFileReader no_file = NoFile;
  GltfBuffers buffers(*document, no_file);
  // The first accessor is that of the bind matrices.
  const absl::StatusOr<std::vector<float>> matrices = buffers.Read(0, 16);
  ASSERT_THAT(matrices.status(), IsOk());
  const std::vector<int>& joints = document->skins[0].joints;
  ASSERT_EQ(matrices->size(), joints.size() * 16);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    retargeting::Vec3d at;
    for (int node = joints[j]; node >= 0;
         node = document->nodes[static_cast<size_t>(node)].parent) {
      at += document->nodes[static_cast<size_t>(node)].translation;
    }
    EXPECT_NEAR(at.x + static_cast<double>((*matrices)[j * 16 + 12]), 0, 1e-6);
    EXPECT_NEAR(at.y + static_cast<double>((*matrices)[j * 16 + 13]), 0, 1e-6);
    EXPECT_NEAR(at.z + static_cast<double>((*matrices)[j * 16 + 14]), 0, 1e-6);
  }
}

TEST(GltfExport, StoresTheProvenanceOfTheFollower) {
  motion::Provenance provenance;
  provenance.candidates = 4;
  provenance.model = "flow";
  provenance.model_version = 3;
  provenance.labels = {{0, {{"hug", 1}}}, {30, {{"push", -0.5f}}}};
  provenance.seed = 7;
  const nlohmann::json json = Json({Person(0, 0), Person(1, 3)}, &provenance);
  const nlohmann::json extras = json["scenes"][0]["extras"];
  EXPECT_EQ(extras["model"], "flow@3");
  EXPECT_EQ(extras["seed"], 7);
  EXPECT_EQ(extras["candidates"], 4);
  EXPECT_EQ(extras["labels"][0]["weights"]["hug"], 1);
  EXPECT_EQ(extras["labels"][1]["frame"], 30);
  EXPECT_EQ(extras["labels"][1]["weights"]["push"], -0.5);
}

}  // namespace
}  // namespace duet::formats::gltf
