// Every part of the local transform of an FBX node, in files that the test writes. The places of
// the joints are those that the formulas of the FBX SDK give.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "contrib/formats/tests/fbx/fbx_fixture.h"
#include "contrib/formats/tests/fbx/text_fbx.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_rig.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::contrib::formats::fbx {
namespace {

using ::duet::formats::ReadOptions;
using retargeting::Vec3d;
using test::FbxBone;
using test::FbxTake;
using test::FromFbx;

constexpr int kFrames = 8;
constexpr float kOneMillimetre = 0.001f;

using Properties = std::map<std::string, Vec3d>;

std::vector<FbxBone> Person() {
  const motion::Clip person = test::MakePerson();
  const absl::Span<const motion::Vec3> pose = person.poses[0];
  return test::FbxPerson({pose.begin(), pose.end()});
}

// Some value that is different for each bone and frame, within `most`.
Vec3d Some(std::size_t bone, int frame, double most) {
  const double phase = 0.7 * static_cast<double>(bone) + 0.35 * frame;
  return Vec3d{std::sin(phase), std::cos(1.3 * phase), std::sin(0.8 * phase + 1)} * most;
}

// A take that animates `property` of every bone about its value in the file.
void Animate(const std::vector<FbxBone>& bones, const std::string& property, double most,
             FbxTake* take) {
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const auto found = bones[b].properties.find(property);
    test::FbxTrack track{static_cast<int>(b), property, {}};
    for (int frame = 0; frame < kFrames; ++frame) {
      const Vec3d unit = property == "Lcl Scaling" ? Vec3d{1, 1, 1} : Vec3d{};
      const Vec3d at_rest = found == bones[b].properties.end() ? unit : found->second;
      track.keys.push_back(at_rest + Some(b, frame, most));
    }
    take->tracks.push_back(std::move(track));
  }
}

FbxTake Turning(const std::vector<FbxBone>& bones) {
  FbxTake take{"move", {}};
  Animate(bones, "Lcl Rotation", 40, &take);
  return take;
}

void ExpectPlacesOfTheSdk(const std::vector<FbxBone>& bones, const std::vector<FbxTake>& takes,
                          const FbxTake& expected) {
  ReadOptions options;
  options.metres_per_unit = 1;
  options.coordinates = motion::Coordinates{};
  options.animation = expected.name;
  const absl::StatusOr<motion::Clip> read = FromFbx(test::TextFbx(bones, takes), options);
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->frame_count(), kFrames);
  float farthest = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::vector<motion::Vec3> places = test::FbxWorld(bones, expected, frame);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const int joint = options.skeleton.Find(bones[b].name);
      farthest = std::max(farthest, Distance(read->at(frame, joint), places[b]));
    }
  }
  EXPECT_LT(farthest, kOneMillimetre);
}

// The properties of every other bone, so that those with and without follow each other.
std::vector<FbxBone> With(const Properties& properties) {
  std::vector<FbxBone> bones = Person();
  for (std::size_t b = 0; b < bones.size(); b += 2) {
    for (const auto& [name, value] : properties) {
      const bool grows = name == "Lcl Scaling" || name == "GeometricScaling";
      bones[b].properties[name] = grows ? value : value + Some(b, 0, 0.1 * Norm(value));
    }
  }
  return bones;
}

TEST(FbxTransformsTest, EachPartOfATransformIsApplied) {
  const std::map<std::string, Properties> cases = {
      {"pre-rotation", {{"PreRotation", {-90, 20, 10}}}},
      {"post-rotation", {{"PostRotation", {30, -60, 15}}}},
      {"both", {{"PreRotation", {0, 180, 90}}, {"PostRotation", {30, -60, 15}}}},
      {"rotation pivot", {{"RotationPivot", {.1, -.2, .05}}}},
      {"small rotation pivot", {{"RotationPivot", {.0005, 0, 0}}}},
      {"rotation offset", {{"RotationOffset", {.1, .05, -.1}}}},
      {"scaling pivot", {{"ScalingPivot", {.1, .2, .05}}, {"Lcl Scaling", {1.2, 1.2, 1.2}}}},
      {"scaling offset", {{"ScalingOffset", {.03, .05, -.1}}, {"PreRotation", {45, 0, 0}}}},
      {"geometric transform",
       {{"GeometricTranslation", {.2, .1, -.3}},
        {"GeometricRotation", {20, 70, -10}},
        {"GeometricScaling", {2, .5, 1}}}},
      {"geometric transform and pre-rotation",
       {{"GeometricTranslation", {.2, .1, -.3}}, {"PreRotation", {-90, 20, 10}}}},
      {"all",
       {{"PreRotation", {-90, 20, 10}},
        {"PostRotation", {30, -60, 15}},
        {"RotationPivot", {.1, -.2, .05}},
        {"RotationOffset", {.1, .05, -.1}},
        {"ScalingPivot", {.1, .2, .05}},
        {"ScalingOffset", {.03, .05, -.1}},
        {"GeometricTranslation", {.2, .1, -.3}}}}};
  for (const auto& [name, properties] : cases) {
    SCOPED_TRACE(name);
    const std::vector<FbxBone> bones = With(properties);
    const FbxTake turning = Turning(bones);
    ExpectPlacesOfTheSdk(bones, {turning}, turning);
    FbxTake all = turning;
    Animate(bones, "Lcl Translation", 0.05, &all);
    Animate(bones, "Lcl Scaling", 0.1, &all);
    all.name = "all";
    ExpectPlacesOfTheSdk(bones, {all}, all);
  }
}

TEST(FbxTransformsTest, EachRotationOrderIsApplied) {
  for (int order = 0; order < 6; ++order) {
    SCOPED_TRACE(order);
    std::vector<FbxBone> bones = With({{"PreRotation", {-90, 20, 10}}});
    for (FbxBone& bone : bones) bone.rotation_order = order;
    ExpectPlacesOfTheSdk(bones, {Turning(bones)}, Turning(bones));
  }
}

TEST(FbxTransformsTest, EachKindOfInheritedScaleIsApplied) {
  for (int type = 0; type < 3; ++type) {
    for (const Vec3d scale : {Vec3d{1, 1, 1}, Vec3d{1.2, 1.2, 1.2}, Vec3d{1.3, .8, 1.1}}) {
      SCOPED_TRACE(::testing::Message() << "type " << type << ", scale " << scale.x);
      std::vector<FbxBone> bones = With({{"Lcl Scaling", scale}, {"PreRotation", {-90, 20, 10}}});
      for (FbxBone& bone : bones) bone.inherit_type = type;
      ExpectPlacesOfTheSdk(bones, {Turning(bones)}, Turning(bones));
      FbxTake stretching = Turning(bones);
      Animate(bones, "Lcl Scaling", 0.2, &stretching);
      ExpectPlacesOfTheSdk(bones, {stretching}, stretching);
    }
  }
}

TEST(FbxTransformsTest, ABoneOfNoSizeHasItsChildrenInItsPlace) {
  std::vector<FbxBone> bones = With({{"Lcl Scaling", {1.3, .8, 1.1}}});
  for (FbxBone& bone : bones) {
    bone.inherit_type = 0;
    if (bone.name == "left_elbow") bone.properties["Lcl Scaling"] = {0, 0, 0};
  }
  ExpectPlacesOfTheSdk(bones, {Turning(bones)}, Turning(bones));
}

// A skin states where its bones were bound relative to the mesh's node, without the geometric
// transform that moves the mesh. The file was saved in another pose.
TEST(FbxTransformsTest, TheRestPoseOfASkinDoesNotDependOnTheMeshsOffset) {
  for (const Properties& offset : {Properties{}, Properties{{"GeometricTranslation", {.2, .1, -.3}},
                                                            {"GeometricRotation", {20, 70, -10}},
                                                            {"Lcl Translation", {.5, 0, .1}},
                                                            {"PreRotation", {0, 30, 0}}}}) {
    SCOPED_TRACE(offset.size());
    std::vector<FbxBone> saved = With({{"PreRotation", {-90, 20, 10}}});
    const test::FbxSkin skin{{"body", -1, offset}, Person()};
    for (std::size_t b = 0; b < saved.size(); ++b) {
      saved[b].properties["Lcl Rotation"] = Some(b, 0, 50);
    }
    const absl::StatusOr<std::string> glb = ConvertFbx(test::TextFbx(saved, {}, &skin));
    ASSERT_THAT(glb, IsOk());
    ::duet::formats::gltf::GltfImportOptions options;
    options.metres_per_unit = 1;
    const absl::StatusOr<retargeting::CharacterRig> rig = ::duet::formats::gltf::ReadGltfRig(
        *glb, "a.glb",
        [](const std::string& name) -> absl::StatusOr<std::string> {
          return absl::NotFoundError(name);
        },
        options);
    ASSERT_THAT(rig, IsOk());
    const std::vector<motion::Vec3> places = test::FbxWorld(Person(), {}, 0);
    for (std::size_t b = 0; b < places.size(); ++b) {
      const auto found = std::find(rig->names.begin(), rig->names.end(), saved[b].name);
      ASSERT_NE(found, rig->names.end());
      const auto at = static_cast<std::size_t>(found - rig->names.begin());
      EXPECT_LT(Distance(ToFloat(rig->positions[at]), places[b]), kOneMillimetre) << saved[b].name;
    }
  }
}

// assimp forgets the parts that only the first take animates.
TEST(FbxTransformsTest, ATakeKeepsPartsThatAnotherTakeDoesNotAnimate) {
  const std::vector<FbxBone> bones = With({{"RotationPivot", {.1, -.2, .05}}});
  FbxTake moving{"other", {}};
  Animate(bones, "Lcl Translation", 0.05, &moving);
  const FbxTake turning = Turning(bones);
  ExpectPlacesOfTheSdk(bones, {turning, moving}, turning);
  ExpectPlacesOfTheSdk(bones, {turning, moving}, moving);
}

// Mixamo's files have a take with the T pose before the motion.
TEST(FbxTransformsTest, TheTakeInWhichTheBodyMovesIsRead) {
  const std::vector<FbxBone> bones = Person();
  FbxTake pose{"Take 001", {}};
  for (std::size_t b = 0; b < bones.size(); ++b) {
    pose.tracks.push_back({static_cast<int>(b), "Lcl Rotation", {Vec3d{}, Vec3d{}}});
  }
  const FbxTake turning = Turning(bones);
  std::vector<std::string> notes;
  ReadOptions options;
  options.metres_per_unit = 1;
  options.notes = &notes;
  const absl::StatusOr<motion::Clip> read = FromFbx(test::TextFbx(bones, {pose, turning}), options);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->frame_count(), kFrames);
  EXPECT_THAT(notes, Contains(AllOf(HasSubstr("\"Take 001\", \"move\""),
                                    HasSubstr("animation: \"move\", the first in which"))));
}

TEST(FbxTransformsTest, ATakeThatStartsLateHasNoFrameBefore) {
  const std::vector<FbxBone> bones = With({{"RotationPivot", {.1, -.2, .05}}});
  FbxTake late = Turning(bones);
  late.first_frame = 30;
  ExpectPlacesOfTheSdk(bones, {late}, late);
}

}  // namespace
}  // namespace duet::contrib::formats::fbx
