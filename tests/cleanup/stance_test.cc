#include "model/cleanup/stance.h"

#include "model/body/passing_poses.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();
const body::Body kBody = body::FindBody(kSkeleton);
constexpr StanceOptions kOptions = {/*enabled=*/true, /*longest_seconds=*/0.6};
constexpr int kLeftFoot = 11, kRightFoot = 14, kLeftHip = 9, kRightHip = 12;

// The right foot stands 0.8 m behind its place between two times in seconds.
motion::Poses Lunge(double begin, double end) {
  return Puppet([=](double t, authoring::PuppetPose* pose) {
    if (t >= begin && t < end) pose->right_foot.target = {-0.12, kAnkle, -0.8};
  });
}

motion::Poses Narrowed(motion::Poses poses, int settled = 0) {
  NarrowStance(kSkeleton, kBody, kOptions, {kRate, settled}, &poses);
  return poses;
}

float Width(const motion::Poses& poses, int t) { return Norm(Stride(kBody, poses[t])); }

int FrameAt(double seconds) { return static_cast<int>(seconds * kRate); }

TEST(NarrowStance, FeetThatStayAstrideComeBelowTheHips) {
  const motion::Poses lunge = Lunge(0.5, 3.1), narrowed = Narrowed(lunge);
  ASSERT_GT(Width(lunge, FrameAt(2)), 0.62f);
  EXPECT_EQ(narrowed[FrameAt(1)], lunge[FrameAt(1)]) << "a step may be long";
  for (int t = FrameAt(1.8); t < FrameAt(2.9); ++t) {
    EXPECT_LT(Width(narrowed, t), 0.4f) << t;
    const Vec3 hips = Lerp(narrowed.at(t, kLeftHip), narrowed.at(t, kRightHip), 0.5f);
    const Vec3 feet = Lerp(narrowed.at(t, kLeftFoot), narrowed.at(t, kRightFoot), 0.5f);
    EXPECT_NEAR(feet.z, hips.z, 0.03f) << t;
    EXPECT_EQ(narrowed.at(t, 0), lunge.at(t, 0)) << "the body stays";
  }
  EXPECT_LT(LargestLengthChange(narrowed, lunge), 1e-3f);
}

TEST(NarrowStance, ALongStepStaysAsItIs) {
  EXPECT_EQ(Narrowed(Lunge(0.5, 1.0)), Lunge(0.5, 1.0));
  EXPECT_EQ(Narrowed(Puppet()), Puppet());
}

TEST(NarrowStance, SettledFramesStayAndCount) {
  const motion::Poses lunge = Lunge(0, 3.1);
  const int settled = FrameAt(0.6);
  const motion::Poses narrowed = Narrowed(lunge, settled);
  for (int t = 0; t < settled; ++t) EXPECT_EQ(narrowed[t], lunge[t]);
  EXPECT_NEAR(Width(narrowed, settled), Width(lunge, settled), 0.1f);
  EXPECT_LT(Width(narrowed, FrameAt(1.5)), 0.4f);
}

TEST(NarrowStance, AModelWithoutALimitStandsAsItLikes) {
  motion::Poses lunge = Lunge(0, 3.1);
  NarrowStance(kSkeleton, kBody, {}, {kRate, 0}, &lunge);
  EXPECT_EQ(lunge, Lunge(0, 3.1));
}

TEST(NarrowStance, SkeletonsWithoutHipsStay) {
  motion::Poses lunge = Lunge(0, 3.1);
  const motion::Poses before = lunge;
  NarrowStance(WithoutHips(), body::FindBody(WithoutHips()), kOptions, {kRate, 0}, &lunge);
  EXPECT_EQ(lunge, before);
}

}  // namespace
}  // namespace duet::cleanup
