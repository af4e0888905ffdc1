#include "model/formats/follower_rig.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
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

TEST_F(FollowerRigTest, ARigIsWrittenInItsOwnFormat) {
  const struct {
    const char* rig;
    const char* written;
  } kCases[] = {{"leader.bvh", "out.bvh"}, {"leader.glb", "out.glb"}, {"leader.glb", "out.gltf"}};
  for (const auto& row : kCases) {
    EXPECT_LT(Error(RoundTrip(row.rig, row.written), Follower()), 0.01)
        << row.rig << " as " << row.written;
  }
}

TEST_F(FollowerRigTest, ARigNeedNotBeAnimated) {
  test::GltfBuilder gltf;
  test::AddPerson(test::MakePerson(), {}, &gltf);
  gltf.json().erase("animations");
  test::WriteTestFile(folder_ / "still.glb", gltf.Binary());
  EXPECT_THAT(FormatOntoRig(Follower(), {folder_ / "still.glb", {}}, Format::kGlb), IsOk());
  EXPECT_THAT(FormatOntoRig(Follower(), {folder_ / "none.glb", {}}, Format::kGlb),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("none.glb")));
}

TEST_F(FollowerRigTest, ReportsTheExtensionsOfRigs) {
  EXPECT_THAT(FormatOntoRig(Follower(), {"rig.csv", {}}, Format::kGlb).status(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("rig.csv: rig: expected a .bvh, .glb or .gltf")));
  for (const Format format : {Format::kCsv, Format::kGlb}) {
    EXPECT_THAT(
        FormatOntoRig(Follower(), {folder_ / "leader.bvh", {}}, format).status(),
        StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("it is written in its own format")));
  }
  EXPECT_THAT(
      FormatOntoRig(Follower(), {"rig.fbx", {}}, Format::kGlb),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("convert it with duet_fbx.py")));
}

}  // namespace
}  // namespace duet::formats
