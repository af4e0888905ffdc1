#include "model/solver/pins.h"

#include <cmath>

#include "gtest/gtest.h"
#include "tests/support/bodies.h"

namespace duet::solver {
namespace {

using motion::Pins;
using motion::Vec3;
using test::kRate;
using test::Puppet;

constexpr int kTorso = 2, kLeftElbow = 4, kRightHand = 8, kLeftKnee = 10, kLeftFoot = 11;

motion::Poses Pinned(const Pins& pins, int given = 0) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const body::Body body = body::FindBody(skeleton);
  motion::Poses follower = Puppet();
  const PinnedBody pinned(skeleton, body, pins, kRate, given, follower);
  pinned.Approach(&follower);
  pinned.Place(&follower);
  return follower;
}

TEST(PinsTest, EveryKindOfJointGetsToItsPin) {
  const struct {
    int joint;
    Vec3 way;
  } cases[] = {{kRightHand, {0.1f, 0.3f, 0.2f}},
               {kRightHand, {0.8f, 0.2f, 0.6f}},  // out of the arm's reach: the body comes
               {kLeftElbow, {0.02f, 0.02f, 0.1f}},
               {kLeftFoot, {0.1f, 0.2f, 0.2f}},
               {kLeftKnee, {0.03f, 0, 0.01f}},
               {kTorso, {0.3f, -0.1f, 0.2f}}};
  for (const double frame : {20.0, 23.5}) {
    for (const auto& c : cases) {
      const Vec3 place = Puppet().at(20, c.joint) + c.way;
      const Pins pins = {{c.joint, frame, place}};
      const motion::Poses follower = Pinned(pins);
      EXPECT_LT(MeanPinDistance(pins, follower, 0), 0.04) << c.joint << " at " << frame;
      EXPECT_LT(test::LargestLengthChange(follower, Puppet()), 1e-3f);
      EXPECT_LT(test::LargestStep(follower), 0.35f);
      EXPECT_LT(Distance(follower.at(0, c.joint), Puppet().at(0, c.joint)), 0.15f);
    }
  }
}

TEST(PinsTest, SoftnessLeavesItsShareOfTheDistance) {
  const Vec3 place = Puppet().at(20, kRightHand) + Vec3{0.1f, 0.3f, 0.1f};
  const double whole = MeanPinDistance({{kRightHand, 20, place}}, Puppet(), 0);
  EXPECT_NEAR(
      MeanPinDistance({{kRightHand, 20, place}}, Pinned({{kRightHand, 20, place, 0.5f}}), 0),
      whole / 2, 0.03);
}

TEST(PinsTest, APinFarAboveDoesNotLiftTheBodyOffItsFeet) {
  const motion::Poses follower = Pinned({{kTorso, 20, {0, 9, 0}}});
  EXPECT_LT(follower.at(20, kTorso).y, Puppet().at(20, kTorso).y + 0.35f);
}

TEST(PinsTest, GivenFramesStay) {
  const Vec3 place = Puppet().at(5, kRightHand) + Vec3{0, 0.3f, 0};
  EXPECT_EQ(Pinned({{kRightHand, 5, place}}, 10), Puppet());
  const motion::Poses later = Pinned({{kRightHand, 12, place}}, 10);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(later[t], Puppet()[t]) << t;
}

}  // namespace
}  // namespace duet::solver
