#include "model/formats/follower_rig.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/file.h"
#include "model/formats/bvh/bvh_document.h"
#include "nlohmann/json.hpp"
#include "tests/formats/asf/asf_fixture.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"

namespace duet::formats {
namespace {

namespace fs = std::filesystem;

// A leader's file in each format that has a rig, and a follower for it.
class FollowerRigTest : public ::testing::Test {
 protected:
  FollowerRigTest() {
    EXPECT_THAT(WritePeople(folder_ / "leader.bvh", Format::kBvh, {test::MakePerson()},
                            motion::SbuSkeleton())
                    .status(),
                IsOk());
    const test::AsfFiles asf = test::MakeAsfFiles(test::MakePerson());
    test::WriteTestFile(folder_ / "leader.asf", asf.asf);
    test::WriteTestFile(folder_ / "leader.amc", asf.amc);
    test::GltfBuilder gltf;
    test::AddPerson(test::MakePerson(), {}, &gltf);
    test::WriteTestFile(folder_ / "leader.glb", gltf.Binary());
  }

  static motion::Clip Follower() {
    test::PersonOptions options;
    options.frames = 60;
    options.yaw = 2;
    options.turn = 3;
    options.at = {0.5f, 1.1f, -1};
    return test::MakePerson(options);
  }

  // Writes the follower on the rig of `rig` as `written`, and reads it back.
  motion::Clip RoundTrip(const std::string& rig, const std::string& written) {
    const fs::path file = folder_ / written;
    const absl::StatusOr<std::string> content =
        FormatOntoRig(Follower(), {folder_ / rig, {}}, *FormatOf(file));
    EXPECT_THAT(content.status(), IsOk());
    test::WriteTestFile(file, content.value_or(""));
    const absl::StatusOr<motion::Clip> read = ReadLeader(file);
    EXPECT_THAT(read.status(), IsOk());
    return read.value_or(motion::Clip());
  }

  test::TemporaryFolder folder_;
};

// The largest distance of hands and feet.
double Error(const motion::Clip& read, const motion::Clip& wanted) {
  EXPECT_EQ(read.frame_count(), wanted.frame_count());
  double largest = 0;
  for (const char* name : {"left_foot", "right_foot", "left_hand", "right_hand"}) {
    const int joint = motion::SbuSkeleton().Find(name);
    for (int frame = 0; frame < std::min(read.frame_count(), wanted.frame_count()); ++frame) {
      largest = std::max(
          largest, static_cast<double>(Distance(read.at(frame, joint), wanted.at(frame, joint))));
    }
  }
  return largest;
}

TEST_F(FollowerRigTest, EveryRigIsWrittenAsBvhAndAsGltf) {
  for (const char* rig : {"leader.amc", "leader.bvh", "leader.glb"}) {
    for (const char* written : {"out.bvh", "out.glb", "out.gltf"}) {
      EXPECT_LT(Error(RoundTrip(rig, written), Follower()), 0.01) << rig << " as " << written;
    }
  }
}

TEST_F(FollowerRigTest, AnotherFormatKeepsNamesAndHierarchy) {
  const absl::StatusOr<std::string> text =
      FormatOntoRig(Follower(), {folder_ / "leader.bvh", {}}, Format::kGltf);
  ASSERT_THAT(text.status(), IsOk());
  const nlohmann::json document = nlohmann::json::parse(*text);
  const absl::StatusOr<std::string> leader =
      base::ReadFile(folder_ / "leader.bvh", 1 << 24, "a rig");
  ASSERT_THAT(leader.status(), IsOk());
  const absl::StatusOr<bvh::BvhDocument> parsed = bvh::ParseBvh(*leader, "leader.bvh");
  ASSERT_THAT(parsed.status(), IsOk());
  const bvh::BvhDocument& rig = *parsed;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const nlohmann::json& node = document["nodes"][j + 1];  // after the one that holds them
    EXPECT_EQ(node["name"], rig.joints[j].name);
    if (rig.joints[j].parent < 0) continue;
    const auto& children =
        document["nodes"][static_cast<std::size_t>(rig.joints[j].parent) + 1]["children"];
    EXPECT_NE(std::find(children.begin(), children.end(), j + 1), children.end()) << node["name"];
  }
  EXPECT_EQ(document["skins"][0]["joints"].size(), rig.joints.size());
}

TEST_F(FollowerRigTest, ARigNeedNotBeAnimated) {
  test::GltfBuilder gltf;
  test::AddPerson(test::MakePerson(), {}, &gltf);
  gltf.json().erase("animations");
  test::WriteTestFile(folder_ / "still.glb", gltf.Binary());
  EXPECT_THAT(CheckRig({folder_ / "still.glb", {}}), IsOk());
  EXPECT_THAT(CheckRig({folder_ / "none.glb", {}}),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("none.glb")));
  EXPECT_THAT(CheckRig({"rig.csv", {}}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("rig.csv")));
}

TEST_F(FollowerRigTest, ABvhOnABvhHasTheUnitOfTheRig) {
  WriteOptions options;
  EXPECT_EQ(BvhUnitOnRig({folder_ / "leader.bvh", {}}, options).value_or(0), kCentimetre);
  WriteOptions metres;
  metres.bvh_metres_per_unit = 1;
  EXPECT_THAT(WritePeople(folder_ / "metres.bvh", Format::kBvh, {test::MakePerson()},
                          motion::SbuSkeleton(), metres)
                  .status(),
              IsOk());
  EXPECT_EQ(BvhUnitOnRig({folder_ / "metres.bvh", {}}, options).value_or(0), 1);
  EXPECT_EQ(BvhUnitOnRig({folder_ / "leader.glb", {}}, metres).value_or(0), 1);
  EXPECT_THAT(BvhUnitOnRig({folder_ / "none.bvh", {}}, options).status(),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("none.bvh")));
}

TEST_F(FollowerRigTest, ReportsTheExtensionsOfRigs) {
  EXPECT_THAT(FormatOntoRig(Follower(), {"rig.csv", {}}, Format::kGlb).status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("rig.csv: rig: expected a .bvh, .amc, .fbx, .glb or .gltf")));
  EXPECT_THAT(FormatOntoRig(Follower(), {folder_ / "leader.bvh", {}}, Format::kCsv).status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("it is written as .bvh, .glb or .gltf")));
  fs::remove(folder_ / "leader.asf");
  EXPECT_THAT(FormatOntoRig(Follower(), {folder_ / "leader.amc", {}}, Format::kGlb).status(),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("leader.asf")));
}

}  // namespace
}  // namespace duet::formats
