#include "model/solver/follower.h"

#include <cmath>

#include "gtest/gtest.h"
#include "model/motion/resample.h"
#include "tests/solver/noisy_person.h"
#include "tests/support/bodies.h"

namespace duet::solver {
namespace {

using motion::Vec3;
using test::kFrames;
using test::Puppet;

constexpr int kTorso = 2, kLeftHip = 9, kRightHip = 12, kLeftFoot = 11, kRightFoot = 14;

motion::Poses Leader(int frames = kFrames) { return test::Moved(Puppet({}, frames), {0, 0, 2}); }

motion::Poses Solved(motion::Poses follower, const motion::Poses& given = {}) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const FollowerSolver solver(skeleton, kRate);
  EXPECT_TRUE(solver.CanSolve());
  const motion::Poses leader = Leader(follower.frame_count());
  Situation situation{leader};
  situation.given = given;
  situation.rules.resize(static_cast<std::size_t>(follower.frame_count()));
  const auto person = BodyModel::Measure(skeleton, given.empty() ? Puppet({}, 1) : given);
  solver.Join(given, &follower);
  solver.Solve(situation, *person, &follower);
  return follower;
}

double HipHeight(const motion::Poses& poses, int t) {
  return (poses.at(t, kLeftHip).y + poses.at(t, kRightHip).y) / 2 -
         std::min(poses.at(t, kLeftFoot).y, poses.at(t, kRightFoot).y);
}

TEST(FollowerSolverTest, APersonWhoStandsHardlyMoves) {
  EXPECT_LT(test::LargestDistance(Solved(Puppet()), Puppet()), 0.03f);
}

TEST(FollowerSolverTest, FeetThatWereMovedDoNotBendTheKnees) {
  // Walks in steps of its own: the network's feet slide.
  const motion::Poses sliding = test::Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{0, 0, -0.02f * static_cast<float>(t)};
  });
  EXPECT_LT(KneeDegrees(Solved(sliding)), KneeDegrees(Puppet()) + 15);
}

TEST(FollowerSolverTest, EndsACrouchAndKeepsAShortDip) {
  const auto crouch = [](double from, double to) {
    return Puppet([=](double at, test::PuppetPose* pose) {
      if (at >= from && at < to) pose->torso.y -= 0.25;
    });
  };
  const double standing = HipHeight(Puppet(), 20);
  const motion::Poses low = crouch(0, 9), dip = crouch(1.4, 1.6);
  ASSERT_LT(HipHeight(low, 20), standing - 0.2);
  EXPECT_GT(HipHeight(Solved(low), 20), standing - 0.14);
  EXPECT_LT(HipHeight(Solved(dip), 22), standing - 0.12);
}

TEST(FollowerSolverTest, APersonWhoIsThrownBackDoesNotSitDown) {
  // Flies back by 0.4 m a frame; the plan made anew is a metre ahead of the given frames.
  constexpr int kGiven = 15;
  const auto back = [](int t, int from, float most) {
    return Vec3{0, 0, -0.4f * std::clamp(static_cast<float>(t - from), 0.0f, most)};
  };
  const motion::Poses given = motion::Part(
      test::Changed(Puppet(), [&](int t, Vec3 joint) { return joint + back(t, 12, 2); }), 0,
      kGiven);
  const motion::Poses plan = test::Changed(
      Puppet(), [&](int t, Vec3 joint) { return t < kGiven ? joint : joint + back(t, 12, 4); });
  const motion::Poses solved = Solved(plan, given);
  for (int t = kGiven; t < kFrames; ++t) {
    EXPECT_GT(HipHeight(solved, t), 0.65 * HipHeight(Puppet(), 0)) << t;
  }
}

TEST(FollowerSolverTest, AFloatingFollowerComesDownAndAJumpStays) {
  const motion::Poses floating = test::Moved(Puppet(), {0, 0.2f, 0});
  const auto low = [](const motion::Poses& poses, int t) {
    return std::min(poses.at(t, kLeftFoot).y, poses.at(t, kRightFoot).y);
  };
  EXPECT_NEAR(low(Solved(floating), 20), low(Puppet(), 20), 0.05f);
  const motion::Poses jump = test::Changed(Puppet(), [](int t, Vec3 joint) {
    const float up = 0.3f - 0.05f * static_cast<float>((t - 22) * (t - 22));
    return joint + Vec3{0, std::max(0.0f, up), 0};
  });
  EXPECT_GT(low(Solved(jump), 22), low(Puppet(), 22) + 0.12f);
}

TEST(FollowerSolverTest, GoesOnFromTheGivenFrames) {
  const motion::Poses given = motion::Part(test::Moved(Puppet(), {0.1f, 0, 0.05f}), 0, 12);
  const motion::Poses solved = Solved(Puppet(), given);
  for (int t = 0; t < 12; ++t) EXPECT_EQ(solved[t], given[t]) << t;
  EXPECT_LT(test::LargestStep(solved), 0.08f);
  for (const int foot : {kLeftFoot, kRightFoot}) {
    EXPECT_LT(Distance(solved.at(14, foot), given.at(11, foot)), 0.002f) << "stands";
  }
}

TEST(FollowerSolverTest, ATurnedOverAndScatteredFollowerStaysFinite) {
  motion::Poses wild = Puppet();
  for (int t = 0; t < kFrames; ++t) {
    for (int joint = 0; joint < 15; ++joint) {
      wild.at(t, joint) = wild.at(t, (joint * 7 + t) % 15) * (t % 3 == 0 ? 0.0f : 1.5f);
    }
  }
  for (const Vec3 joint : Solved(wild).all()) EXPECT_TRUE(IsFinite(joint));
  EXPECT_EQ(Solved(wild), Solved(wild));
}

TEST(FollowerSolverTest, NeedsABody) {
  EXPECT_FALSE(FollowerSolver(test::WithoutHips(), kRate).CanSolve());
  EXPECT_FALSE(FollowerSolver(test::WithoutFeet(), kRate).CanSolve());
}

TEST(KeepFeetBetweenTest, FeetStayOnTheWayBetweenTheirPlaces) {
  const motion::Poses person = Puppet({}, 2);
  std::vector<Vec3> pose(person[0].begin(), person[0].end());
  pose[kLeftFoot] += Vec3{0.03f, -0.02f, 0.01f};
  KeepFeetBetween(body::FindBody(motion::SbuSkeleton()), person[0], person[1],
                  absl::MakeSpan(pose));
  EXPECT_EQ(pose[kLeftFoot], person.at(0, kLeftFoot));
  EXPECT_EQ(pose[kTorso], person.at(0, kTorso));
}

}  // namespace
}  // namespace duet::solver
