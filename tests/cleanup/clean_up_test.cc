#include "model/cleanup/clean_up.h"

#include "model/authoring/puppet.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

motion::Poses Cleaned(motion::Poses follower, int settled = 0, const Options& options = {}) {
  const std::size_t frames = static_cast<std::size_t>(follower.frame_count());
  CleanUp(motion::SbuSkeleton(), options)
      .Apply(Puppet({}, follower.frame_count()), Touch(frames, 0), Meetings(frames),
             {kRate, settled}, &follower);
  return follower;
}

// Opposite of the leader, swaying on feet that stand, waving.
motion::Poses Clean() {
  const motion::Poses swaying = Puppet([](double t, authoring::PuppetPose* pose) {
    pose->torso = {0.04 * std::sin(2 * t), 1.07 + 0.02 * std::sin(3 * t), 0.03 * std::cos(t)};
    pose->right_hand.target = {-0.3, 0.2 + 0.1 * std::sin(8 * t), 0.2};
    pose->chest.pitch = 10 * std::sin(3 * t);
  });
  return Changed(swaying, [](int, Vec3 joint) {
    return RotateY(joint, 3.14159265) + Vec3{0, 0, 1.2f};
  });
}

// Everything at once: leans, floats, slides and stands in the leader.
motion::Poses Soiled() {
  return Changed(Puppet(), [](int t, Vec3 joint) {
    const float seconds = static_cast<float>(t / kRate);
    return LeanForwards(RotateY(joint, 3.14159265), -25) +
           Vec3{0.04f * std::sin(3 * seconds), 0.12f, 0.2f};
  });
}

TEST(CleanUp, AMotionThatIsCleanStays) {
  EXPECT_LT(LargestDistance(Cleaned(Clean()), Clean()), 1e-3f);
  EXPECT_LT(LargestDistance(Cleaned(Clean(), 15), Clean()), 1e-3f);
}

TEST(CleanUp, SettledFramesStayBitForBit) {
  const motion::Poses cleaned = Cleaned(Soiled(), 15);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(cleaned[t], Soiled()[t]);
  EXPECT_NE(cleaned[20], Soiled()[20]);
}

TEST(CleanUp, BonesKeepTheirLengths) {
  EXPECT_LT(LargestLengthChange(Cleaned(Soiled()), Soiled()), 1e-5f);
}

TEST(CleanUp, EveryStageHasItsSwitch) {
  Options none;
  none.upright.enabled = none.spacing.enabled = none.capsules.enabled = false;
  none.waist.enabled = none.floor.enabled = none.footsteps.enabled = none.raised_limbs.enabled =
      none.joint_ranges.enabled = false;
  none.shoulders.enabled = none.limb_swings.enabled = false;
  const motion::Poses soiled = Moved(Soiled(), {3, 0, 0});
  EXPECT_EQ(Cleaned(soiled, 0, none), soiled);
  EXPECT_EQ(Cleaned(Soiled(), 0, none), Soiled());
  const auto alone = [&](auto set, const motion::Poses& poses) {
    Options one = none;
    set(&one);
    return Cleaned(poses, 0, one);
  };
  EXPECT_LT(LeanDegrees(alone([](Options* o) { o->upright.enabled = true; }, soiled), 9), 14.01);
  EXPECT_LT(alone([](Options* o) { o->spacing.enabled = true; }, soiled).at(9, 2).x, 2.9f);
  EXPECT_GT(
      LargestDistance(alone([](Options* o) { o->capsules.enabled = true; }, Soiled()), Soiled()),
      0.01f);
  EXPECT_LT(alone([](Options* o) { o->floor.enabled = true; }, soiled).at(9, 2).y,
            soiled.at(9, 2).y - 0.05f);
  EXPECT_NE(alone([](Options* o) { o->footsteps.enabled = true; }, Moved(soiled, {0, -0.12f, 0})),
            Moved(soiled, {0, -0.12f, 0}));
  motion::Poses tilted = Puppet();  // one shoulder is far above the other
  for (int t = 0; t < kFrames; ++t) tilted.at(t, 3).y += 0.3f;
  EXPECT_NE(alone([](Options* o) { o->shoulders.enabled = true; }, tilted), tilted);
  motion::Poses snapping = Puppet();  // a forearm turns over in a frame
  for (int t = 20; t < kFrames; ++t) snapping.at(t, 8) = snapping.at(t, 7) * 2 - snapping.at(t, 8);
  EXPECT_NE(alone([](Options* o) { o->limb_swings.enabled = true; }, snapping), snapping);
  motion::Poses broken = Puppet();
  for (int t = 0; t < kFrames; ++t) broken.at(t, 11) += {0, 0.2f, 0.3f};  // a knee bends forwards
  EXPECT_NE(alone([](Options* o) { o->joint_ranges.enabled = true; }, broken), broken);
}

TEST(CleanUp, ShortWindowsAndSingleFramesAreValid) {
  for (const int frames : {1, 2, 3}) {
    motion::Poses soiled = Soiled();
    soiled.Resize(frames);
    const motion::Poses cleaned = Cleaned(soiled);
    for (const Vec3& joint : cleaned.all()) EXPECT_TRUE(IsFinite(joint));
    EXPECT_EQ(Cleaned(soiled, frames), soiled);
  }
}

TEST(CleanUp, ABodyInOnePointStaysFinite) {
  const motion::Poses point(kFrames, 15);
  const motion::Poses cleaned = Cleaned(point);
  for (const Vec3& joint : cleaned.all()) EXPECT_TRUE(IsFinite(joint));
}

}  // namespace
}  // namespace duet::cleanup
