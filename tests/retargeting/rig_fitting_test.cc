#include "model/retargeting/rig_fitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/foot_pose.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

using base::kDegreesPerRadian;
using test::MakePerson;
using test::PersonOptions;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();

// The poses of a clip, fitted one after the other.
std::vector<RigPose> Fit(const Rig& rig, const motion::Clip& clip) {
  RigFitter fitter(kSkeleton, rig, clip.frame_rate_hz, AnkleHeightOnFloor(kSkeleton, clip),
                   BoneLengths::kRigs);
  std::vector<RigPose> poses;
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    poses.push_back(fitter.Fit(clip.poses[frame]));
  }
  return poses;
}

std::size_t Find(const Rig& rig, const std::string& name) {
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    if (rig.joints[j].name == name) return j;
  }
  ADD_FAILURE() << "no joint " << name;
  return 0;
}

Quaternion World(const Rig& rig, const RigPose& pose, std::size_t joint) {
  Quaternion world = pose.rotations[joint];
  for (int j = rig.joints[joint].parent; j >= 0;
       j = rig.joints[static_cast<std::size_t>(j)].parent) {
    world = pose.rotations[static_cast<std::size_t>(j)] * world;
  }
  return world;
}

// The largest turn of a bone about itself from one frame to the next, degrees.
double MostTwist(const Rig& rig, const std::vector<RigPose>& poses, const std::string& name) {
  const std::size_t joint = Find(rig, name);
  const Vec3d rest = rig.joints[joint].rest_direction;
  double most = 0;
  for (std::size_t frame = 1; frame < poses.size(); ++frame) {
    const Quaternion before = World(rig, poses[frame - 1], joint);
    const Quaternion after = World(rig, poses[frame], joint);
    const Quaternion carried =
        ShortestArc(Rotate(before, rest), Rotate(after, rest), {0, 1, 0}) * before;
    most = std::max(most, Angle(carried, after) * kDegreesPerRadian);
  }
  return most;
}

double WorstDistance(const Rig& rig, const motion::Clip& clip, const std::vector<RigPose>& poses) {
  double worst = 0;
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const std::vector<Vec3d> at = JointPositions(rig, poses[static_cast<std::size_t>(frame)]);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
      worst = std::max(worst, Norm(at[j] - ToDouble(clip.at(frame, rig.joints[j].joint))));
    }
  }
  return worst;
}

// Stands still; the left arm reaches sideways and its elbow bends by `bend` radians, upwards before
// the middle frame and forwards from it on.
motion::Clip TurningElbow(double bend, double frame_rate_hz) {
  PersonOptions still;
  still.frame_rate_hz = frame_rate_hz;
  motion::Clip clip = MakePerson(still);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    for (int joint = 0; joint < clip.joint_count(); ++joint) {
      clip.at(frame, joint) = clip.at(0, joint);
    }
    const motion::Vec3 shoulder = clip.at(frame, kSkeleton.Find("left_shoulder"));
    const motion::Vec3 elbow = shoulder + motion::Vec3{0.3F, 0, 0};
    const auto along = static_cast<float>(0.25 * std::cos(bend));
    const auto aside = static_cast<float>(0.25 * std::sin(bend));
    const bool up = frame < clip.frame_count() / 2;
    clip.at(frame, kSkeleton.Find("left_elbow")) = elbow;
    clip.at(frame, kSkeleton.Find("left_hand")) =
        elbow + (up ? motion::Vec3{along, aside, 0} : motion::Vec3{along, 0, aside});
  }
  return clip;
}

TEST(RigFitter, ForwardKinematicsGivesThePositionsBack) {
  PersonOptions turning;
  turning.turn = 14;
  turning.frames = 200;
  const motion::Clip clip = MakePerson(turning);
  const Rig rig = MakeRig(kSkeleton, clip);
  EXPECT_LT(WorstDistance(rig, clip, Fit(rig, clip)), 1e-5);
}

TEST(RigFitter, AnElbowWhosePlaneJumpsTurnsOverAFewFrames) {
  for (const double rate : {15.0, 30.0, 60.0}) {
    const motion::Clip clip = TurningElbow(1.2, rate);
    const Rig rig = MakeRig(kSkeleton, clip);
    const std::vector<RigPose> poses = Fit(rig, clip);
    for (const char* bone : {"left_shoulder", "left_elbow"}) {
      const double most = MostTwist(rig, poses, bone);
      EXPECT_LT(most, 45) << bone << " at " << rate;
      EXPECT_LT(most * rate, 900) << bone << " at " << rate;
    }
    EXPECT_LT(WorstDistance(rig, clip, poses), 1e-5) << "turning a bone moves no joint";
    // It arrives: its hinge is again across the plane of the arm.
    const Quaternion last = World(rig, poses.back(), Find(rig, "left_shoulder"));
    EXPECT_GT(std::abs(Rotate(last, {0, 1, 0}).y), 0.99) << "at " << rate;
  }
}

TEST(RigFitter, AnAlmostStraightElbowKeepsItsPlane) {
  const motion::Clip clip = TurningElbow(0.05, 30);
  const Rig rig = MakeRig(kSkeleton, clip);
  EXPECT_LT(MostTwist(rig, Fit(rig, clip), "left_shoulder"), 5);
}

// A trunk that turns far from one frame to the next takes no bone along in one frame.
TEST(RigFitter, ATrunkThatTurnsOverDoesNotSpinTheLimbs) {
  motion::Clip clip = TurningElbow(1.2, 30);
  const motion::Vec3 root = clip.at(0, kSkeleton.root);
  const Quaternion turn = AxisAngle({0, 1, 0}, 150 * base::kRadiansPerDegree);
  for (int frame = clip.frame_count() / 2; frame < clip.frame_count(); ++frame) {
    for (int joint = 0; joint < clip.joint_count(); ++joint) {
      motion::Vec3& at = clip.at(frame, joint);
      at = ToFloat(ToDouble(root) + Rotate(turn, ToDouble(at - root)));
    }
  }
  const Rig rig = MakeRig(kSkeleton, clip);
  const std::vector<RigPose> poses = Fit(rig, clip);
  for (const char* bone : {"left_shoulder", "left_elbow", "right_hip", "left_knee"}) {
    EXPECT_LT(MostTwist(rig, poses, bone) * 30, 900) << bone;
  }
}

Quaternion World(const RigAnimation& animation, int frame, std::size_t joint) {
  return World(animation.rig, animation.frames[static_cast<size_t>(frame)], joint);
}

TEST(RigAnimation, TheRestPoseStandsOnTheFloorAtTheOrigin) {
  PersonOptions away;
  away.at = {5, 3, 2};
  const RigAnimation animation = AnimateRig(motion::SbuSkeleton(), MakePerson(away));
  double lowest = 1;
  for (const Vec3d& position : animation.rest_positions) lowest = std::min(lowest, position.y);
  EXPECT_EQ(lowest, 0);
  EXPECT_EQ(animation.rest_positions[0].x, 0);
  EXPECT_GT(animation.rest_positions[Find(animation.rig, "head")].y, 1.2);
}

TEST(RigAnimation, NeighbouringFramesAreOnTheSameSide) {
  PersonOptions turning;
  turning.turn = 14;
  turning.frames = 200;
  const RigAnimation animation = AnimateRig(motion::SbuSkeleton(), MakePerson(turning));
  for (std::size_t frame = 1; frame < animation.frames.size(); ++frame) {
    for (std::size_t j = 0; j < animation.rig.joints.size(); ++j) {
      EXPECT_GT(Dot(animation.frames[frame].rotations[j], animation.frames[frame - 1].rotations[j]),
                0.5);
    }
  }
}

// Somebody who stands with bent knees: the shins lean, the soles do not.
TEST(RigAnimation, AStandingFootIsLevelAndALiftedOneFollowsItsShin) {
  motion::Clip clip = MakePerson();
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const int knee = skeleton.Find("left_knee"), foot = skeleton.Find("left_foot");
  const int hip = skeleton.Find("left_hip"), other = skeleton.Find("right_foot");
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const motion::Vec3 at = clip.at(frame, hip);
    const bool stands = frame < clip.frame_count() / 2;
    clip.at(frame, knee) = at + motion::Vec3{0, -0.35f, 0.25f};
    clip.at(frame, foot) = {at.x, stands ? 0.1f : 0.5f, at.z};
    clip.at(frame, other).y = 0.1f;
  }
  const RigAnimation animation = AnimateRig(skeleton, clip);
  const std::size_t joint = Find(animation.rig, "left_foot"),
                    shin = Find(animation.rig, "left_knee");
  const int last = clip.frame_count() - 1;
  EXPECT_NEAR(Rotate(World(animation, 0, joint), {0, 0, 1}).y, 0, 1e-6);
  EXPECT_NEAR(Rotate(World(animation, 0, joint), {0, 1, 0}).y, 1, 1e-6);
  EXPECT_LT(Rotate(World(animation, 0, shin), {0, 1, 0}).y, 0.97);
  EXPECT_NEAR(Angle(World(animation, last, joint), World(animation, last, shin)), 0, 1e-6);
}

constexpr int kFrames = 200;
constexpr double kRate = 30;

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
