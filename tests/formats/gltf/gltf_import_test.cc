#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/gltf/gltf_motion.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::formats::gltf {
namespace {

using test::AddPerson;
using test::GltfBuilder;
using test::GltfPersonOptions;
using test::LargestDistance;
using test::MakePerson;

constexpr float kOneMillimetre = 0.001f;

absl::StatusOr<std::string> NoFiles(const std::string& name) {
  return absl::NotFoundError(name + ": no such file");
}

absl::StatusOr<motion::Clip> Read(const std::string& content,
                                  const GltfImportOptions& options = {}) {
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, "a.glb");
  if (!document.ok()) return document.status();
  return FromGltf(*document, "a.glb", NoFiles, options);
}

std::string ReadError(const std::string& content, const GltfImportOptions& options = {}) {
  const absl::StatusOr<motion::Clip> clip = Read(content, options);
  EXPECT_EQ(clip.status().code(), absl::StatusCode::kInvalidArgument) << clip.status();
  return std::string(clip.status().message());
}

// Expects that the file has the motion of `clip`.
void ExpectReads(const std::string& content, const motion::Clip& clip,
                 const GltfImportOptions& options = {}) {
  const absl::StatusOr<motion::Clip> read = Read(content, options);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->frame_rate_hz, clip.frame_rate_hz);
  EXPECT_LT(LargestDistance(*read, clip), kOneMillimetre);
}

std::string OnePerson(const motion::Clip& clip, const GltfPersonOptions& options = {}) {
  GltfBuilder builder;
  AddPerson(clip, options, &builder);
  return builder.Binary();
}

TEST(GltfImport, ReadsAPersonWithEveryInterpolation) {
  for (const char* interpolation : {"LINEAR", "STEP", "CUBICSPLINE"}) {
    SCOPED_TRACE(interpolation);
    GltfPersonOptions options;
    options.interpolation = interpolation;
    ExpectReads(OnePerson(MakePerson(), options), MakePerson());
  }
}

TEST(GltfImport, AppliesTheAncestorsOfTheSkeleton) {
  GltfPersonOptions options;
  options.centimetres_below_an_armature = true;
  retargeting::ReadingReport report;
  GltfImportOptions read_options;
  read_options.report = &report;
  ExpectReads(OnePerson(MakePerson(), options), MakePerson(), read_options);
  EXPECT_THAT(report.Notes(), Contains(HasSubstr("unit: metres")));
}

TEST(GltfImport, ReadsEitherCharacterOfAFileWithTwo) {
  const motion::Clip people[] = {MakePerson({30}), MakePerson({45, 3, 0, {0, 1, 1.5f}, 30})};
  for (const bool with_skin : {true, false}) {
    GltfBuilder builder;
    GltfPersonOptions options;
    options.with_skin = with_skin;
    AddPerson(people[0], options, &builder);
    options.animation = "dance";
    AddPerson(people[1], options, &builder);
    GltfImportOptions read_options;
    for (; read_options.person < 2; ++read_options.person) {
      ExpectReads(builder.Binary(), people[read_options.person], read_options);
    }
  }
}

TEST(GltfImport, SeveralSkinsOfOneSkeletonAreOneCharacter) {
  GltfBuilder builder;
  AddPerson(MakePerson(), {}, &builder);
  const nlohmann::json joints = builder.json()["skins"][0]["joints"];
  builder.json()["skins"].push_back({{"joints", {joints[3], joints[4]}}});
  GltfImportOptions second;
  second.person = 1;  // there is none: the first
  ExpectReads(builder.Binary(), MakePerson(), second);
}

// A person with the animation "walk", and a copy of it.
GltfBuilder WithTwoAnimations(const std::string& second) {
  GltfBuilder builder;
  AddPerson(MakePerson(), {}, &builder);
  nlohmann::json other = builder.json()["animations"][0];
  other["name"] = second;
  builder.json()["animations"].push_back(other);
  return builder;
}

// Puts an animation before the others in which joints only tremble, radians.
void AddPose(const std::string& name, float tremble, GltfBuilder* builder) {
  const int times = builder->AddAccessor({0, 0.5f, 1}, "SCALAR");
  const int turns = builder->AddAccessor({0, 0, 0, 1, tremble / 2, 0, 0, 1, 0, 0, 0, 1}, "VEC4");
  nlohmann::json& animations = builder->json()["animations"];
  nlohmann::json pose = {{"name", name}};
  pose["samplers"] = nlohmann::json::array({{{"input", times}, {"output", turns}}});
  for (nlohmann::json channel : animations[0]["channels"]) {
    if (channel["target"]["path"] != "rotation") continue;
    channel["sampler"] = 0;
    pose["channels"].push_back(channel);
  }
  animations.insert(animations.begin(), pose);
}

TEST(GltfImport, UsesTheFirstAnimationInWhichTheBodyMoves) {
  const motion::Clip clip = MakePerson();
  for (const float tremble : {0.0f, 0.002f}) {
    GltfBuilder builder = WithTwoAnimations("run");
    AddPose("T pose", tremble, &builder);
    retargeting::ReadingReport report;
    GltfImportOptions options;
    options.report = &report;
    ExpectReads(builder.Binary(), clip, options);
    EXPECT_THAT(report.Notes(),
                Contains(HasSubstr("animation: \"walk\", the first in which the body moves "
                                   "of 3 that move the skeleton: \"T pose\", \"walk\"")));
    options.animation = "T pose";
    EXPECT_EQ(Read(builder.Binary(), options)->frame_count(), 31);
  }
}

TEST(GltfImport, WarnsOfAnAnimationInWhichNothingMoves) {
  GltfBuilder builder;
  AddPerson(MakePerson(), {}, &builder);
  AddPose("T pose", 0, &builder);
  builder.json()["animations"].erase(1);
  retargeting::ReadingReport report;
  GltfImportOptions options;
  options.report = &report;
  ASSERT_THAT(Read(builder.Binary(), options), IsOk());
  EXPECT_THAT(report.Notes(), Contains("warning: animation: \"T pose\": no joint moves"));
}

TEST(GltfImport, AnAnimationIsChosenByItsName) {
  const GltfBuilder builder = WithTwoAnimations("Rig|run");
  retargeting::ReadingReport report;
  GltfImportOptions options;
  options.report = &report;
  for (const char* name : {"walk", "Rig|run", "run"}) {
    options.animation = name;
    EXPECT_TRUE(Read(builder.Binary(), options).ok()) << name;
  }
  EXPECT_THAT(report.Notes(), Not(Contains(HasSubstr("animation: "))));
  options.animation = "ru\n";
  EXPECT_THAT(ReadError(builder.Binary(), options),
              HasSubstr("animation: expected \"walk\", \"Rig|run\", got \"ru\\n\""));
}

TEST(GltfImport, SamplesAtTheKeysRateOrTheSpecifiedOne) {
  motion::Clip clip = MakePerson({25});
  clip.frame_rate_hz = 24;
  retargeting::ReadingReport report;
  GltfImportOptions options;
  options.report = &report;
  const absl::StatusOr<motion::Clip> as_keyed = Read(OnePerson(clip), options);
  ASSERT_THAT(as_keyed, IsOk());
  EXPECT_EQ(as_keyed->frame_rate_hz, 24);
  EXPECT_EQ(as_keyed->frame_count(), 25);
  EXPECT_THAT(report.Notes(), Contains(HasSubstr("frame rate: 24 Hz")));
  options.frame_rate_hz = 48;
  const absl::StatusOr<motion::Clip> given = Read(OnePerson(clip), options);
  ASSERT_THAT(given, IsOk());
  EXPECT_EQ(given->frame_rate_hz, 48);
  ASSERT_EQ(given->frame_count(), 49);
  for (int frame = 0; frame < 25; ++frame) {
    EXPECT_LT(Distance(given->at(2 * frame, 5), clip.at(frame, 5)), kOneMillimetre) << frame;
  }
  clip.frame_rate_hz = 2;  // keyed by hand
  options.frame_rate_hz.reset();
  EXPECT_EQ(Read(OnePerson(clip), options)->frame_rate_hz, 30);
}

// Times in floats fall short of whole frames by their rounding.
TEST(GltfImport, KeepsTheLastFrame) {
  for (int frames = 2; frames < 40; ++frames) {
    const absl::StatusOr<motion::Clip> read = Read(OnePerson(MakePerson({frames})));
    ASSERT_THAT(read, IsOk());
    EXPECT_EQ(read->frame_count(), frames);
  }
}

TEST(GltfImport, RejectsFilesWithoutAMovingSkeleton) {
  EXPECT_THAT(ReadError(R"({"asset": {"version": "2.0"}})"),
              HasSubstr("a.glb: expected a skeleton, got no skin and no animated node"));
  GltfBuilder builder;
  AddPerson(MakePerson({2}), {}, &builder);
  builder.json().erase("animations");
  EXPECT_THAT(ReadError(builder.Binary()),
              HasSubstr("a.glb: expected an animation of the skeleton, got none"));
}

TEST(GltfImport, RejectsMoreFramesThanAMotionMayHave) {
  GltfBuilder builder;
  motion::Clip slow = MakePerson({3});
  slow.frame_rate_hz = 1e-4;
  AddPerson(slow, {}, &builder);
  EXPECT_THAT(ReadError(builder.Binary()), HasSubstr("expected at most 200000 frames"));
}

TEST(GltfImport, RejectsMoreNodesThanASkeletonMayHave) {
  GltfBuilder builder;
  AddPerson(MakePerson({2}), {}, &builder);
  for (int i = 0; i < 1024; ++i) {
    builder.json()["nodes"][0]["children"].push_back(builder.AddNode({{"name", "leaf"}}));
  }
  EXPECT_THAT(ReadError(builder.Binary()),
              HasSubstr("skeleton: expected at most 1024 nodes, got 10"));
}

}  // namespace
}  // namespace duet::formats::gltf
