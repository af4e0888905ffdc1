#include <algorithm>
#include <cstddef>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/rig_fitting.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

using test::MakePerson;
using test::PersonOptions;

constexpr int kFrames = 200;
constexpr double kRate = 30;
const motion::Skeleton kSkeleton = motion::SbuSkeleton();

motion::Clip Person() {
  PersonOptions person;
  person.frames = kFrames;
  person.frame_rate_hz = kRate;
  return MakePerson(person);
}

// The poses of frames [first, kFrames) of a fit that begins there.
std::vector<RigPose> FitFrom(int first, const Rig& rig, const motion::Clip& clip) {
  EndlessRigFitter fitter(kSkeleton, rig, kRate, AnkleHeightOnFloor(kSkeleton, clip));
  std::vector<RigPose> poses;
  for (int frame = first; frame < kFrames; ++frame) {
    poses.push_back(fitter.Fit(frame, clip.poses[frame]));
  }
  return poses;
}

bool Same(const RigPose& a, const RigPose& b) {
  return std::equal(a.rotations.begin(), a.rotations.end(), b.rotations.begin(),
                    [](const Quaternion& p, const Quaternion& q) {
                      return p.w == q.w && p.x == q.x && p.y == q.y && p.z == q.z;
                    });
}

TEST(EndlessRigFitterTest, AFitThatBeginsWithTheHistoryContinuesWithTheSamePoses) {
  const motion::Clip clip = Person();
  const Rig rig = MakeRig(kSkeleton, clip);
  const std::vector<RigPose> whole = FitFrom(0, rig, clip);
  const int history = EndlessRigFitter::HistoryFrames(kRate);
  EXPECT_EQ(history, 60);
  for (const int resumed : {60, 61, 89, 90, 91, 130}) {
    const int first = resumed - history;
    const std::vector<RigPose> rest = FitFrom(first, rig, clip);
    for (int frame = resumed; frame < kFrames; ++frame) {
      const auto at = static_cast<std::size_t>(frame);
      EXPECT_TRUE(Same(whole[at], rest[at - static_cast<std::size_t>(first)]))
          << "resumed at " << resumed << ", frame " << frame;
    }
  }
}

TEST(EndlessRigFitterTest, LessHistoryGivesOtherPoses) {
  const motion::Clip clip = Person();
  const Rig rig = MakeRig(kSkeleton, clip);
  const std::vector<RigPose> whole = FitFrom(0, rig, clip), rest = FitFrom(119, rig, clip);
  EXPECT_FALSE(Same(whole[125], rest[6]));
}

TEST(EndlessRigFitterTest, JointsAreWhereTheFrameHasThem) {
  const motion::Clip clip = Person();
  Rig rig = MakeRig(kSkeleton, clip);
  SetBoneLengths(clip.poses[0], &rig);
  const std::vector<RigPose> poses = FitFrom(0, rig, clip);
  double worst = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::vector<Vec3d> at = JointPositions(rig, poses[static_cast<std::size_t>(frame)]);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
      worst = std::max(worst, Norm(at[j] - ToDouble(clip.at(frame, rig.joints[j].joint))));
    }
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(EndlessRigFitterTest, NothingJumpsWhereAnotherFitBegins) {
  const motion::Clip clip = Person();
  const Rig rig = MakeRig(kSkeleton, clip);
  const std::vector<RigPose> poses = FitFrom(0, rig, clip);
  for (std::size_t joint = 0; joint < rig.joints.size(); ++joint) {
    double fastest = 0;
    for (std::size_t frame = 1; frame < poses.size(); ++frame) {
      if (frame % 30 == 0) continue;
      fastest = std::max(fastest,
                         Angle(poses[frame - 1].rotations[joint], poses[frame].rotations[joint]));
    }
    for (std::size_t frame = 30; frame < poses.size(); frame += 30) {
      const double turn = Angle(poses[frame - 1].rotations[joint], poses[frame].rotations[joint]);
      EXPECT_LT(turn, 1.5 * fastest + base::kRadiansPerDegree) << rig.joints[joint].name;
    }
  }
}

}  // namespace
}  // namespace duet::retargeting
