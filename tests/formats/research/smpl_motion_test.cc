#include "model/formats/research/smpl_motion.h"

#include <map>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/file.h"
#include "model/formats/motion_file.h"
#include "model/formats/research/body_joints.h"
#include "tests/formats/research/npz_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::formats::research {
namespace {

constexpr float kQuarter = 1.57079633f;

using Arrays = std::map<std::string, std::string>;

class SmplMotionTest : public ::testing::Test {
 protected:
  static std::vector<float> Poses(int frames) {
    return std::vector<float>(static_cast<std::size_t>(frames) * 156);
  }
  static Arrays Motion(const std::vector<float>& poses) {
    const int frames = static_cast<int>(poses.size() / 156);
    return {{"poses", test::Array({frames, 156}, poses)},
            {"trans",
             test::Array({frames, 3}, std::vector<float>(static_cast<std::size_t>(frames) * 3))},
            {"mocap_framerate", test::Array({}, {120})}};
  }

  absl::StatusOr<motion::Clip> Read(const Arrays& motion,
                                    const Arrays& model = test::TinyBodyModel()) {
    EXPECT_TRUE(base::WriteFile(folder_ / "m.npz", test::MakeNpz(motion)).ok());
    EXPECT_TRUE(base::WriteFile(folder_ / "body.npz", test::MakeNpz(model)).ok());
    ReadOptions options;
    options.skeleton = BodySkeleton();
    options.body_model = folder_ / "body.npz";
    report_ = {};
    options.report = &report_;
    return ReadLeader(folder_ / "m.npz", options);
  }
  std::string Error(const Arrays& motion, const Arrays& model = test::TinyBodyModel()) {
    return std::string(Read(motion, model).status().message());
  }

  static void ExpectAt(const motion::Clip& clip, int joint, motion::Vec3 at) {
    EXPECT_LT(Distance(clip.at(0, joint), at), 1e-5f)
        << clip.at(0, joint).x << " " << clip.at(0, joint).y << " " << clip.at(0, joint).z;
  }

  test::TemporaryFolder folder_;
  retargeting::ReadingReport report_;
};

TEST_F(SmplMotionTest, WithoutRotationsTheBodyIsAtRest) {
  const absl::StatusOr<motion::Clip> clip = Read(Motion(Poses(2)));
  ASSERT_TRUE(clip.ok()) << clip.status();
  EXPECT_EQ(clip->frame_count(), 2);
  EXPECT_EQ(clip->frame_rate_hz, 120);
  const BodyPose rest = test::TinyBodyJoints();
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    ExpectAt(*clip, joint, ToFloat(rest[static_cast<std::size_t>(joint)]));
  }
}

TEST_F(SmplMotionTest, AJointTurnsItsChildrenAboutItself) {
  std::vector<float> poses = Poses(1);
  poses[3 * kLeftElbow + 2] = kQuarter;  // about z: the left forearm points up
  const absl::StatusOr<motion::Clip> clip = Read(Motion(poses));
  ASSERT_TRUE(clip.ok()) << clip.status();
  ExpectAt(*clip, kLeftElbow, {0.5f, 0.5f, 0});
  ExpectAt(*clip, kLeftWrist, {0.5f, 0.75f, 0});
}

// AMASS: z up, so that the person's root is turned by a quarter about x.
TEST_F(SmplMotionTest, ZUpBecomesYUp) {
  std::vector<float> poses = Poses(1);
  poses[0] = kQuarter;
  Arrays motion = Motion(poses);
  motion["trans"] = test::Array({1, 3}, {1, 2, 3});
  const absl::StatusOr<motion::Clip> clip = Read(motion);
  ASSERT_TRUE(clip.ok()) << clip.status();
  ASSERT_TRUE(report_.up_axis.has_value());
  EXPECT_EQ(report_.up_axis->value, "z-up");
  ExpectAt(*clip, kPelvis, {1, 3, -2.1f});
  ExpectAt(*clip, kHead, {1, 3.6f, -2.1f});
  ExpectAt(*clip, kLeftAnkle, {1.1f, 2.1f, -2.1f});
}

TEST_F(SmplMotionTest, BetasShapeTheBody) {
  Arrays motion = Motion(Poses(1));
  motion["betas"] = test::Array({4}, {2, 0.1f, 9, 9});  // the model has two shapes
  const absl::StatusOr<motion::Clip> clip = Read(motion);
  ASSERT_TRUE(clip.ok()) << clip.status();
  ExpectAt(*clip, kLeftHip, {0.3f, 0, 0});
  ExpectAt(*clip, kHead, {0, 0.8f, 0});
  motion["betas"] = test::Array({2, 2}, {2, 0.1f, 0, 0});  // the first row counts
  const absl::StatusOr<motion::Clip> rows = Read(motion);
  ASSERT_TRUE(rows.ok()) << rows.status();
  EXPECT_EQ(rows->poses, clip->poses);
}

TEST_F(SmplMotionTest, ReadsRootAndBodyApart) {
  std::vector<float> body(63);
  body[3 * (kLeftElbow - 1) + 2] = kQuarter;
  const absl::StatusOr<motion::Clip> clip = Read({{"root_orient", test::Array({1, 3}, {0, 0, 0})},
                                                  {"pose_body", test::Array({1, 21, 3}, body)},
                                                  {"fps", test::Array({1}, {30})}});
  ASSERT_TRUE(clip.ok()) << clip.status();
  ExpectAt(*clip, kLeftWrist, {0.5f, 0.75f, 0});
}

TEST_F(SmplMotionTest, TheFifteenJointsAreMapped) {
  ASSERT_TRUE(Read(Motion(Poses(1))).ok());
  ReadOptions options;
  options.body_model = folder_ / "body.npz";
  const absl::StatusOr<motion::Clip> clip = ReadLeader(folder_ / "m.npz", options);
  ASSERT_TRUE(clip.ok()) << clip.status();
  const int hand = motion::SbuSkeleton().Find("left_hand");
  ExpectAt(*clip, hand, {0.75f, 0.5f, 0});
}

TEST_F(SmplMotionTest, ErrorsNameTheArray) {
  ReadOptions options;
  ASSERT_TRUE(Read(Motion(Poses(1))).ok());
  EXPECT_THAT(std::string(ReadLeader(folder_ / "m.npz", options).status().message()),
              HasSubstr("body model: expected the .npz of the motion's body model, got none"));
  EXPECT_THAT(Error({{"v_template", "x"}}), HasSubstr("expected an array poses, got"));
  Arrays motion = Motion(Poses(1));
  motion["poses"] = test::Array({1, 65}, std::vector<float>(65));
  EXPECT_THAT(Error(motion), HasSubstr("poses: shape: expected (frames, 66 or more), got (1, 65)"));
  motion = Motion(Poses(2));
  motion["trans"] = test::Array({1, 3}, {0, 0, 0});
  EXPECT_THAT(Error(motion), HasSubstr("trans: shape: expected (2, 3), got (1, 3)"));
  motion = Motion(Poses(1));
  motion.erase("mocap_framerate");
  EXPECT_THAT(Error(motion), HasSubstr("frame rate: expected one, got none in the file"));
  Arrays model = test::TinyBodyModel();
  model["J_regressor"] = test::Array({22, 3}, std::vector<float>(66));
  EXPECT_THAT(Error(Motion(Poses(1)), model),
              HasSubstr("J_regressor: shape: expected (joints, 22) with at least 22 joints"));
  model = test::TinyBodyModel();
  model["kintree_table"] = test::Array({2, 22}, std::vector<float>(44));
  EXPECT_THAT(Error(Motion(Poses(1)), model),
              HasSubstr("parent of joint 4: expected 1 as in SMPL, SMPL+H and SMPL-X, got 0"));
  model.erase("v_template");
  EXPECT_THAT(Error(Motion(Poses(1)), model), HasSubstr("expected an array v_template, got"));
}

TEST_F(SmplMotionTest, OnlyMotionsAreTakenForMotions) {
  ASSERT_TRUE(Read(Motion(Poses(1))).ok());
  EXPECT_TRUE(MayBeSmplMotion(folder_ / "m.npz"));
  EXPECT_FALSE(MayBeSmplMotion(folder_ / "body.npz"));
  EXPECT_FALSE(MayBeSmplMotion(folder_ / "none.npz"));
}

}  // namespace
}  // namespace duet::formats::research
