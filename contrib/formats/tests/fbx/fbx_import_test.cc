// Reads the files of make_files.py, which Blender wrote, and of make_text_file.py, which assimp
// wrote. Their source is the sample leaders.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "contrib/formats/tests/fbx/fbx_fixture.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/file.h"
#include "model/formats/follower_rig.h"
#include "model/formats/motion_file.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"

namespace duet::contrib::formats::fbx {
namespace {

namespace fs = std::filesystem;
using ::duet::formats::Format;
using ::duet::formats::FormatOntoRig;
using ::duet::formats::ParseLeader;
using ::duet::formats::ReadLeader;
using ::duet::formats::ReadOptions;
using ::duet::formats::Side;
using test::FromFbx;
using test::LargestDistance;

constexpr float kOneMillimetre = 0.001f;
constexpr int kFirst = 20;  // of the samples' frames, as in make_files.py

fs::path SourceFolder() {
  const char* const folder = std::getenv("DUET_SOURCE_DIR");
  return folder == nullptr ? "" : folder;
}

std::string File(const std::string& name) {
  return test::ReadTestFile(SourceFolder() / "contrib/formats/tests/fbx/files" / (name + ".fbx"));
}

// A part of a clip, played at another rate.
motion::Clip Part(const motion::Clip& whole, int frames, double rate_hz) {
  motion::Clip part;
  part.joint_names = whole.joint_names;
  part.frame_rate_hz = rate_hz;
  part.Append(whole.poses.frames(kFirst, frames));
  return part;
}

motion::Clip Sample(const std::string& name, int frames, double rate_hz = 30) {
  const absl::StatusOr<motion::Clip> whole =
      ReadLeader(SourceFolder() / "samples" / (name + ".bvh"));
  EXPECT_TRUE(whole.ok()) << whole.status();
  return whole.ok() ? Part(*whole, frames, rate_hz) : motion::Clip();
}

void ExpectNear(const absl::StatusOr<motion::Clip>& read, const motion::Clip& source) {
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->frame_count(), source.frame_count());
  EXPECT_EQ(read->frame_rate_hz, source.frame_rate_hz);
  EXPECT_LT(LargestDistance(*read, source), kOneMillimetre);
}

TEST(FbxTest, EveryRateUnitAndAxisGivesTheSourcesPositions) {
  const std::map<std::string, double> files = {
      {"centimetres_y_up_30", 30}, {"metres_z_up_24", 24}, {"metres_y_up_60", 60}};
  for (const auto& [name, rate_hz] : files) {
    SCOPED_TRACE(name);
    ExpectNear(FromFbx(File(name)), Sample("kick", 12, rate_hz));
  }
}

// text_z_up_24 with other statements.
std::string TextFile(const std::vector<std::pair<std::string, std::string>>& replacements) {
  const std::string text = File("text_z_up_24");
  for (const auto& [old, unused] : replacements) EXPECT_THAT(text, HasSubstr(old));
  return absl::StrReplaceAll(text, replacements);
}

// The modes of FbxTime (FBX SDK, FbxTime::EMode) in the order of their numbers. Mode 0 is the
// default of the SDK; the file states 24 Hz beside it.
TEST(FbxTest, EachTimeModeIsARate) {
  const double ntsc = 30000.0 / 1001, film = 24000.0 / 1001;
  const std::vector<double> rates = {24, 120,  100,  60, 50, 48,   30,
                                     30, ntsc, ntsc, 25, 24, 1000, film};
  const std::string mode = "\"TimeMode\", \"enum\", \"\", \"\", ";
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const absl::StatusOr<motion::Clip> read =
        FromFbx(TextFile({{mode + "11\n", absl::StrCat(mode, i, "\n")}}));
    ASSERT_THAT(read, IsOk()) << i;
    // The times of a glTF's keys do not distinguish 29.97 Hz from 30, and 240 Hz is read at most.
    EXPECT_NEAR(read->frame_rate_hz, std::min(rates[i], 240.0), 0.04) << "mode " << i;
  }
}

TEST(FbxTest, ATextOfEachVersionGivesTheSourcesPositions) {
  ExpectNear(FromFbx(File("text_z_up_24")), Sample("kick", 12, 24));
  for (const char* version : {"7100", "7200", "7300", "7400", "7500", "7700"}) {
    SCOPED_TRACE(version);
    const std::string text =
        TextFile({{"FBXVersion: 7500", absl::StrCat("FBXVersion: ", version)}});
    ExpectNear(FromFbx(text), Sample("kick", 12, 24));
  }
  EXPECT_THAT(FromFbx(TextFile({{"FBXVersion: 7500", "FBXVersion: 6100"}})).status().message(),
              HasSubstr("expected FBX 7.1 or later"));
}

absl::StatusOr<motion::Clip> ReadWithUnit(const std::string& centimetres) {
  const std::string before = "\"UnitScaleFactor\", \"double\", \"Number\", \"\", ";
  return FromFbx(
      TextFile({{absl::StrCat(before, "100\n"), absl::StrCat(before, centimetres, "\n")}}));
}

TEST(FbxTest, ATextOfEachUnitIsScaled) {
  const motion::Clip source = Sample("kick", 12, 24);
  for (const char* centimetres : {"91.44", "120"}) {  // yards; any other
    SCOPED_TRACE(centimetres);
    const absl::StatusOr<motion::Clip> read = ReadWithUnit(centimetres);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_NEAR(read->at(3, 0).y, source.at(3, 0).y * std::stof(centimetres) / 100, 1e-5f);
  }
}

// Many programs state a unit that is not the file's.
TEST(FbxTest, AUnitThatNobodysSizeFitsIsInferred) {
  for (const char* centimetres : {"0.1", "2.54", "30.48"}) {
    SCOPED_TRACE(centimetres);
    ExpectNear(ReadWithUnit(centimetres), Sample("kick", 12, 24));
  }
}

TEST(FbxTest, ATextOfEachAxisIsTurned) {
  const motion::Clip source = Sample("kick", 12, 24);
  const std::string up = "\"UpAxis\", \"int\", \"Integer\", \"\", 2";
  const std::string sign = "\"UpAxisSign\", \"int\", \"Integer\", \"\", 1";
  ReadOptions as_stated;  // not the axis along which the person stands
  as_stated.coordinates = motion::Coordinates{};
  // The same numbers with another axis up: (x, y, z) in a file with z up is (x, z, -y) in Duet.
  const absl::StatusOr<motion::Clip> y_up =
      FromFbx(TextFile({{up, "\"UpAxis\", \"int\", \"Integer\", \"\", 1"}}), as_stated);
  const absl::StatusOr<motion::Clip> y_down =
      FromFbx(TextFile({{up, "\"UpAxis\", \"int\", \"Integer\", \"\", 1"},
                        {sign, "\"UpAxisSign\", \"int\", \"Integer\", \"\", -1"}}),
              as_stated);
  ASSERT_TRUE(y_up.ok()) << y_up.status();
  ASSERT_TRUE(y_down.ok()) << y_down.status();
  for (int joint = 0; joint < source.joint_count(); ++joint) {
    const motion::Vec3 p = source.at(5, joint);
    EXPECT_LT(Distance(y_up->at(5, joint), {p.x, -p.z, p.y}), kOneMillimetre);
    EXPECT_LT(Distance(y_down->at(5, joint), {p.x, p.z, -p.y}), kOneMillimetre);
  }
}

TEST(FbxTest, OptionsOverrideTheFile) {
  ReadOptions options;
  options.metres_per_unit = 2;
  options.frame_rate_hz = 60;
  const absl::StatusOr<motion::Clip> read = FromFbx(File("centimetres_y_up_30"), options);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->frame_count(), 23);  // the same time at twice the rate
  const motion::Clip source = Sample("kick", 12);
  EXPECT_NEAR(read->at(0, 0).y, 2 * source.at(0, 0).y, kOneMillimetre);
}

// Mixamo's names: the head is half way to HeadTop_End, as it is half way to a BVH's End Site.
TEST(FbxTest, ARigWithMixamosNamesIsMapped) {
  const fs::path samples = SourceFolder() / "samples";
  std::string bvh = test::ReadTestFile(samples / "kick.bvh");
  const std::pair<const char*, const char*> names[] = {
      {"torso", "Spine1"}, {"neck", "Neck"}, {"head", "Head"}};
  for (const auto& [joint, name] : names) {
    for (const char* word : {"ROOT ", "JOINT "}) {
      bvh = absl::StrReplaceAll(
          bvh, {{absl::StrCat(word, joint, "\n"), absl::StrCat(word, "mixamorig:", name, "\n")}});
    }
  }
  const std::pair<const char*, const char*> sided[] = {{"shoulder", "Arm"}, {"elbow", "ForeArm"},
                                                       {"hand", "Hand"},    {"hip", "UpLeg"},
                                                       {"knee", "Leg"},     {"foot", "Foot"}};
  for (const auto& [joint, name] : sided) {
    bvh = absl::StrReplaceAll(
        bvh,
        {{absl::StrCat("JOINT left_", joint, "\n"), absl::StrCat("JOINT Left", name, "\n")},
         {absl::StrCat("JOINT right_", joint, "\n"), absl::StrCat("JOINT Right", name, "\n")}});
  }
  ReadOptions options;
  options.format = Format::kBvh;
  const absl::StatusOr<motion::Clip> source = ParseLeader(bvh, "renamed.bvh", options);
  ASSERT_TRUE(source.ok()) << source.status();
  ExpectNear(FromFbx(File("mixamo_skin_30")), Part(*source, 12, 30));
}

TEST(FbxTest, ATakeIsChosenByItsName) {
  std::vector<std::string> notes;
  ReadOptions options;
  options.notes = &notes;
  ExpectNear(FromFbx(File("two_takes_30"), options), Sample("kick", 6));
  EXPECT_THAT(notes, Contains(AllOf(HasSubstr("Rig|kick"), HasSubstr("Rig|punch"))));
  for (const char* name : {"punch", "Rig|punch"}) {
    options.animation = name;
    ExpectNear(FromFbx(File("two_takes_30"), options), Sample("punch", 6));
  }
  options.animation = "walk";
  const absl::Status status = FromFbx(File("two_takes_30"), options).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(),
              HasSubstr("animation: expected \"Rig|kick\", \"Rig|punch\", got \"walk\""));
}

TEST(FbxTest, BothPeopleAreRead) {
  ExpectNear(FromFbx(File("two_people_30")), Sample("kick", 3));
  retargeting::ReadingReport report;
  ReadOptions options;
  options.side = Side::kRight;
  options.report = &report;
  ExpectNear(FromFbx(File("two_people_30"), options), Sample("punch", 3));
  EXPECT_EQ(report.people, 2);
}

// assimp would give both people the motion of one.
TEST(FbxTest, PeopleWhoseBonesHaveTheSameNamesAreRejected) {
  EXPECT_THAT(FromFbx(File("same_names_30")).status().message(),
              HasSubstr("expected a name for each animated node, got several named"));
}

// The bones of the first skin that move a vertex of a binary glTF file, by their names.
std::set<std::string> BonesOfVertices(const std::string& glb) {
  constexpr std::size_t kJsonAt = 20, kChunkHeader = 8;
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + kJsonAt - kChunkHeader, sizeof json_bytes);
  const nlohmann::json json = nlohmann::json::parse(glb.substr(kJsonAt, json_bytes));
  const char* const buffer = glb.data() + kJsonAt + json_bytes + kChunkHeader;
  const auto values = [&](const nlohmann::json& accessor) {
    const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return buffer + view.value("byteOffset", 0) + accessor.value("byteOffset", 0);
  };
  std::set<std::string> bones;
  for (const nlohmann::json& mesh : json["meshes"]) {
    const nlohmann::json& attributes = mesh["primitives"][0]["attributes"];
    const nlohmann::json& accessor = json["accessors"][attributes["JOINTS_0"].get<std::size_t>()];
    const char* const joints = values(accessor);
    const char* const weights =
        values(json["accessors"][attributes["WEIGHTS_0"].get<std::size_t>()]);
    for (std::size_t i = 0; i < 4 * accessor["count"].get<std::size_t>(); ++i) {
      std::uint16_t joint = 0;
      float weight = 0;
      std::memcpy(&joint, joints + i * sizeof joint, sizeof joint);
      std::memcpy(&weight, weights + i * sizeof weight, sizeof weight);
      if (weight == 0) continue;
      const std::size_t node = json["skins"][0]["joints"].at(joint).get<std::size_t>();
      bones.insert(json["nodes"][node]["name"].get<std::string>());
    }
  }
  return bones;
}

class FbxRigTest : public ::testing::Test {
 protected:
  // A clip on the rig of an FBX file, converted to glTF first.
  absl::StatusOr<std::string> OntoRig(const std::string& name, Format format) const {
    const absl::StatusOr<std::string> glb = ConvertFbx(File(name));
    if (!glb.ok()) return glb.status();
    const fs::path rig = folder_.path() / "rig.glb";
    absl::Status status = base::WriteFile(rig, *glb);
    if (!status.ok()) return status;
    return FormatOntoRig(follower_, {rig, {}}, format);
  }

  const test::TemporaryFolder folder_;
  const motion::Clip follower_ = test::MakePerson();
};

TEST_F(FbxRigTest, AFollowerOnTheRigKeepsItsSkin) {
  for (const char* name : {"still_skin", "mixamo_skin_30"}) {
    SCOPED_TRACE(name);
    const absl::StatusOr<std::string> glb = OntoRig(name, Format::kGlb);
    ASSERT_TRUE(glb.ok()) << glb.status();
    EXPECT_THAT(*glb, AllOf(HasSubstr("JOINTS_0"), HasSubstr("mixamorig:LeftForeArm")));
    EXPECT_THAT(BonesOfVertices(*glb),
                ElementsAre("mixamorig:LeftForeArm", "mixamorig:LeftUpLeg",
                            "mixamorig:RightForeArm", "mixamorig:RightUpLeg"));
    ReadOptions options;
    options.format = Format::kGlb;
    options.metres_per_unit = 1;
    const absl::StatusOr<motion::Clip> read = ParseLeader(*glb, "rig.glb", options);
    ASSERT_TRUE(read.ok()) << read.status();
    ASSERT_EQ(read->frame_count(), follower_.frame_count());
    const int foot = motion::SbuSkeleton().Find("left_foot");
    for (int frame = 0; frame < follower_.frame_count(); ++frame) {
      EXPECT_LT(Distance(read->at(frame, foot), follower_.at(frame, foot)), 0.01f) << frame;
    }
  }
}

TEST(FbxTest, ARigWithoutAMotionIsNoLeader) {
  EXPECT_THAT(FromFbx(File("still_skin")).status().message(),
              HasSubstr("expected an animation of the skeleton, got none"));
}

TEST(FbxTest, WhatIsNotFbxIsRejected) {
  for (const std::string& content : {std::string(), std::string("HIERARCHY\nROOT Hips"),
                                     std::string("Kaydara FBX Binary  \0\x1a\0", 23)}) {
    EXPECT_EQ(FromFbx(content).status().code(), absl::StatusCode::kInvalidArgument);
  }
}

TEST(FbxTest, TruncatedFilesAreRejected) {
  const std::string whole = File("still_skin");
  for (std::size_t tenth = 1; tenth < 10; ++tenth) {
    const absl::Status status = ConvertFbx(whole.substr(0, whole.size() * tenth / 10)).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << tenth;
  }
}

}  // namespace
}  // namespace duet::contrib::formats::fbx
