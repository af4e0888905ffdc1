#include "model/cleanup/spacing.h"

#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

motion::Poses Spaced(motion::Poses follower, int settled = 0) {
  KeepSpacing(2, Puppet({}, follower.frame_count()), {}, {kRate, settled}, &follower);
  return follower;
}

float DistanceAt(const motion::Poses& follower, int frame) {
  const Vec3 offset = follower.at(frame, 2) - Vec3{0, 1.1f, 0};
  return std::hypot(offset.x, offset.z);
}

TEST(KeepSpacing, MovesADistantFollowerNearer) {
  const motion::Poses far = Moved(Puppet(), {3, 0, 4});
  const motion::Poses near = Spaced(far);
  for (int t = 0; t < kFrames; ++t) EXPECT_LE(DistanceAt(near, t), 2.751f);
  EXPECT_LT(LargestLengthChange(near, far), 1e-5f);
  EXPECT_EQ(near.at(5, 2).y, far.at(5, 2).y);
}

TEST(KeepSpacing, MovesATooNearFollowerAway) {
  EXPECT_NEAR(DistanceAt(Spaced(Moved(Puppet(), {0.05f, 0, 0})), 9), 0.15f, 1e-4f);
}

TEST(KeepSpacing, AFollowerInRangeIsUnchanged) {
  EXPECT_EQ(Spaced(Moved(Puppet(), {0, 0, 2.4f})), Moved(Puppet(), {0, 0, 2.4f}));
}

TEST(KeepSpacing, AShortViolationIsUnchanged) {
  const motion::Poses lunge = Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{t > 20 && t < 24 ? 2.6f : 2.2f, 0, 0};
  });
  EXPECT_EQ(Spaced(lunge), lunge);
}

TEST(KeepSpacing, SettledFramesAreUnchangedAndSpeedIsLimited) {
  const motion::Poses far = Moved(Puppet(), {3.5f, 0, 0});
  const motion::Poses near = Spaced(far, 15);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(near[t], far[t]);
  EXPECT_LE(LargestStep(near), 0.5f / 15 + 1e-5f);
  EXPECT_NEAR(DistanceAt(near, kFrames - 1), 2.75f, 0.02f);
}

TEST(KeepSpacing, AFollowerKeepsUpWithALeaderWhoWalks) {
  const motion::Poses walking = Changed(Puppet(), [](int t, Vec3 joint) {
    return joint - Vec3{1.2f * static_cast<float>(t / kRate), 0, 0};
  });
  motion::Poses follower = Moved(Puppet(), {2.4f, 0, 0});
  const motion::Poses stands = follower;
  KeepSpacing(2, walking, {}, {kRate, 15}, &follower);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(follower[t], stands[t]);
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_LT(Distance(follower.at(t, 2), walking.at(t, 2)), 3.6f) << t;
  }
  EXPECT_GT(Distance(stands.at(kFrames - 1, 2), walking.at(kFrames - 1, 2)), 4.5f);
  // A leader who jumps does not drag it along.
  motion::Poses jumping = Puppet();
  for (Vec3& joint : jumping[kFrames - 1]) joint.x -= 100;
  follower = stands;
  KeepSpacing(2, jumping, {}, {kRate, 15}, &follower);
  EXPECT_LT(LargestStep(follower), 2.0f / static_cast<float>(kRate) + 1e-4f);
}

}  // namespace
}  // namespace duet::cleanup
