#include "model/cleanup/live_bounds.h"

#include <algorithm>
#include <cmath>

#include "model/base/angle.h"
#include "model/body/limbs.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kSettled = 15;
const motion::Skeleton kSkeleton = motion::SbuSkeleton();

motion::Poses Bounded(const motion::Poses& leader, motion::Poses follower, int settled = kSettled) {
  const LiveBounds bounds(kSkeleton);
  bounds.BoundBody(leader, {kRate, settled}, &follower);
  bounds.BoundFeet(leader, {kRate, settled}, &follower);
  return follower;
}

// A leader two metres away from the puppet.
motion::Poses Leader() { return Moved(Puppet(), {0, 0, 2}); }

// Bent forwards at the hips, by degrees for each frame. Feet stay.
template <typename Degrees>
motion::Poses Bent(const Degrees& degrees) {
  motion::Poses poses = Puppet();
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 pivot =
        Lerp(poses.at(t, kSkeleton.hips->left), poses.at(t, kSkeleton.hips->right), 0.5f);
    for (int j = 0; j < poses.joint_count(); ++j) {
      if (j == 10 || j == 11 || j == 13 || j == 14) continue;  // knees and feet
      poses.at(t, j) = pivot + RotateAbout(poses.at(t, j) - pivot, {1, 0, 0},
                                           degrees(t) * base::kRadiansPerDegree);
    }
  }
  return poses;
}

double TrunkLean(const motion::Poses& poses, int frame) {
  const Vec3 trunk = poses.at(frame, 1) - Lerp(poses.at(frame, kSkeleton.hips->left),
                                               poses.at(frame, kSkeleton.hips->right), 0.5f);
  return std::atan2(std::hypot(trunk.x, trunk.z), trunk.y) * base::kDegreesPerRadian;
}

// The largest mean over a second, without the settled frames' own.
double LargestMeanLean(const motion::Poses& poses) {
  double largest = 0;
  const int second = static_cast<int>(kRate);
  for (int t = kSettled + second; t < poses.frame_count(); ++t) {
    double sum = 0;
    for (int past = t - second + 1; past <= t; ++past) sum += TrunkLean(poses, past);
    largest = std::max(largest, sum / second);
  }
  return largest;
}

float DistanceAt(const motion::Poses& leader, const motion::Poses& follower, int frame) {
  const Vec3 apart = follower.at(frame, kSkeleton.root) - leader.at(frame, kSkeleton.root);
  return std::hypot(apart.x, apart.z);
}

TEST(LiveBoundsTest, AnOrdinaryFollowerStays) { EXPECT_EQ(Bounded(Leader(), Puppet()), Puppet()); }

TEST(LiveBoundsTest, SettledFramesStay) {
  const motion::Poses bent = Bent([](int) { return 50; });
  const motion::Poses bounded = Bounded(Moved(bent, {0, 0, 0.05f}), Moved(bent, {0, 0.3f, 0}));
  for (int t = 0; t < kSettled; ++t) {
    for (int j = 0; j < bent.joint_count(); ++j) {
      EXPECT_EQ(bounded.at(t, j), Moved(bent, {0, 0.3f, 0}).at(t, j));
    }
  }
}

TEST(LiveBoundsTest, ALeanThatLastsIsBounded) {
  for (const double degrees : {20.0, 35.0, 60.0}) {
    const motion::Poses bent = Bent(
        [degrees](int t) { return t < kSettled ? 0.0 : std::min(degrees, 6.0 * (t - kSettled)); });
    EXPECT_GT(LargestMeanLean(bent), 18);
    const motion::Poses bounded = Bounded(Leader(), bent);
    // Highest in the second of a sudden deep bow.
    EXPECT_LT(LargestMeanLean(bounded), 23) << degrees;
    EXPECT_LT(TrunkLean(bounded, kFrames - 1), 21) << degrees;
    EXPECT_LT(LargestLengthChange(bounded, bent), 1e-5f);
    for (const int foot : {11, 14}) {
      EXPECT_LT(Distance(bounded.at(40, foot), bent.at(40, foot)), 0.02f);
    }
  }
}

TEST(LiveBoundsTest, AShortBowStays) {
  const motion::Poses bow = Bent([](int t) {
    const double at = (t - 20) / (0.5 * kRate);
    return at > 0 && at < 1 ? 35 * std::sin(base::kPi * at) : 0;
  });
  EXPECT_GT(TrunkLean(bow, 24), 30);
  EXPECT_GT(TrunkLean(Bounded(Leader(), bow), 24), TrunkLean(bow, 24) - 3);
}

TEST(LiveBoundsTest, AFollowerInsideItsLeaderStepsAside) {
  const motion::Poses follower = Moved(Puppet(), {0.02f, 0, 0});
  const motion::Poses bounded = Bounded(Puppet(), follower);
  EXPECT_GT(DistanceAt(Puppet(), bounded, kSettled + 3), 0.17f);
  EXPECT_GT(bounded.at(30, 0).x, follower.at(30, 0).x) << "away from the leader";
}

TEST(LiveBoundsTest, AFollowerFarAwayComesNearer) {
  const motion::Poses leader = Moved(Puppet(), {0, 0, 3.5f});
  const motion::Poses bounded = Bounded(leader, Puppet());
  EXPECT_LT(DistanceAt(leader, bounded, kFrames - 1), 2.7f);
}

TEST(LiveBoundsTest, ALeaderWhoIsElsewhereAtOnceDoesNotDragTheFollower) {
  const motion::Poses leader = Changed(Puppet(), [](int t, Vec3 joint) {
    return t < 20 ? joint + Vec3{0, 0, 1} : joint + Vec3{6, 0, 6};
  });
  const motion::Poses bounded = Bounded(leader, Puppet());
  const double fastest = LiveBoundOptions().fastest_metres_per_second;
  for (int t = kSettled; t < kFrames; ++t) {
    const float way = Distance(bounded.at(t, kSkeleton.root), Puppet().at(t, kSkeleton.root));
    EXPECT_LE(way, fastest * (t - kSettled + 1) / kRate + 1e-4) << t;
  }
}

TEST(LiveBoundsTest, OneFootStaysNearTheFloor) {
  for (const float height : {0.3f, -0.3f}) {
    const motion::Poses bounded = Bounded(Leader(), Moved(Puppet(), {0, height, 0}));
    for (int t = kSettled + 3; t < kFrames; ++t) {
      EXPECT_LT(std::abs(bounded.at(t, 11).y - kAnkle), 0.041) << t;
    }
  }
}

TEST(LiveBoundsTest, APlanThatLeapsOffTheFloorIsBoundedAtOnce) {
  for (const float leap : {0.2f, 0.3f, -0.3f}) {
    const motion::Poses plan = Changed(Puppet(), [leap](int t, Vec3 joint) {
      return t < kSettled ? joint : joint + Vec3{0, leap, 0};
    });
    const motion::Poses bounded = Bounded(Leader(), plan);
    EXPECT_LT(std::abs(bounded.at(kSettled, 11).y - kAnkle), 0.041) << leap;
  }
}

TEST(LiveBoundsTest, FeetThatTakeTurnsAreNotBothInTheAirInBetween) {
  const body::Body body = body::FindBody(kSkeleton);
  motion::Poses poses = Puppet();
  for (int t = 20; t < kFrames; ++t) {
    const body::Limb& leg = body.legs[static_cast<size_t>(t % 2)];
    ReachBent(leg, poses.at(t, leg.end) + Vec3{0, 0.2f, 0}, {0, 0, 1}, poses[t]);
  }
  const auto lower_in_between = [&body](const motion::Poses& moved, int t) {
    float lower = 1;
    for (const body::Limb& leg : body.legs) {
      lower = std::min(lower, (moved.at(t - 1, leg.end).y + moved.at(t, leg.end).y) / 2);
    }
    return lower - static_cast<float>(kAnkle);
  };
  const motion::Poses bounded = Bounded(Leader(), poses);
  for (int t = 21; t < kFrames; ++t) {
    EXPECT_GT(lower_in_between(poses, t), 0.09f) << t;
    EXPECT_LT(lower_in_between(bounded, t), 0.041f) << t;
  }
  EXPECT_LT(LargestLengthChange(bounded, poses), 1e-4f);
}

TEST(LiveBoundsTest, ASkeletonWithoutHipsAndFeetKeepsItsDistance) {
  motion::Skeleton skeleton = kSkeleton;
  skeleton.hips.reset();
  skeleton.feet.reset();
  motion::Poses follower = Bent([](int) { return 50; });
  const motion::Poses before = follower;
  const LiveBounds bounds(skeleton);
  bounds.BoundBody(Leader(), {kRate, kSettled}, &follower);
  bounds.BoundFeet(Leader(), {kRate, kSettled}, &follower);
  EXPECT_EQ(follower, before);
}

}  // namespace
}  // namespace duet::cleanup
