#include "gtest/gtest.h"
#include "model/engine/windows.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using test::SwayingMotion;

constexpr int kTorso = 2, kLeftHip = 9, kRightHip = 12;

SynthesisWindow Window() {
  SynthesisWindow window;
  window.leader = SwayingMotion(4, 15);
  return window;
}

// Where a point that lies at `offset` from the leader's root comes to lie.
motion::Vec3 Standard(const SynthesisWindow& window, motion::Vec3 offset) {
  return WindowStandardisation(motion::SbuSkeleton(), window)
      .Apply(window.leader.at(0, kTorso) + offset);
}

void ExpectNear(motion::Vec3 got, motion::Vec3 wanted) {
  EXPECT_LT(Distance(got, wanted), 1e-5f) << got.x << " " << got.y << " " << got.z << ", expected "
                                          << wanted.x << " " << wanted.y << " " << wanted.z;
}

TEST(WindowStandardisation, TurnsTheFacingDirectionToMinusZ) {
  const SynthesisWindow window = Window();
  motion::Vec3 across = window.leader.at(0, kRightHip) - window.leader.at(0, kLeftHip);
  across.y = 0;
  const motion::Vec3 facing = Cross(motion::Vec3{0, 1, 0}, across) / Norm(across);
  ExpectNear(Standard(window, facing), {0, 0, -1});
}

TEST(WindowStandardisation, TurnsTheStartToMinusZ) {
  SynthesisWindow window = Window();
  window.start = FollowerStart{window.leader.at(0, kTorso) + motion::Vec3{0.3f, 0.1f, 0.4f}, {}};
  ExpectNear(Standard(window, {0.3f, 0.1f, 0.4f}), {0, 0.1f, -0.5f});
}

TEST(WindowStandardisation, PartnerDirectionGoesBeforeTheStart) {
  SynthesisWindow window = Window();
  window.start = FollowerStart{window.leader.at(0, kTorso) + motion::Vec3{0, 0, 1}, {}};
  window.partner_direction = motion::Vec3{-5, 0, 0};
  ExpectNear(Standard(window, {-1, 0, 0}), {0, 0, -1});
}

TEST(WindowStandardisation, AStartOnTheSpotHasNoDirection) {
  const SynthesisWindow without = Window();
  SynthesisWindow close = Window();
  close.start = FollowerStart{close.leader.at(0, kTorso) + motion::Vec3{0.2f, 0.9f, 0}, {}};
  ExpectNear(Standard(close, {1, 2, 3}), Standard(without, {1, 2, 3}));
}

TEST(WindowStandardisation, WithoutHipsOnlyADirectionTurns) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  SynthesisWindow window = Window();
  EXPECT_EQ(WindowStandardisation(skeleton, window).yaw(), 0);
  window.partner_direction = motion::Vec3{1, 0, 0};
  ExpectNear(WindowStandardisation(skeleton, window)
                 .Apply(window.leader.at(0, kTorso) + motion::Vec3{1, 0, 0}),
             {0, 0, -1});
}

TEST(WindowStandardisation, EveryWayKeepsTheOriginAskedFor) {
  SynthesisWindow by_hips = Window(), by_start = Window(), by_direction = Window();
  by_start.start = FollowerStart{by_start.leader.at(0, kTorso) + motion::Vec3{0, 0, 1}, {}};
  by_direction.partner_direction = motion::Vec3{1, 0, 0};
  for (const SynthesisWindow& window : {by_hips, by_start, by_direction}) {
    const motion::Vec3 way = window.leader.at(3, kTorso) - window.leader.at(0, kTorso);
    const auto frame =
        WindowStandardisation(motion::SbuSkeleton(), window, motion::StandardOrigin::kFirstFrame);
    ASSERT_GT(Norm(way), 0.01f);
    EXPECT_NEAR(Norm(frame.Apply(window.leader).at(3, kTorso)), Norm(way), 1e-5f);
  }
}

}  // namespace
}  // namespace duet::engine
