#include "model/engine/body_fit.h"

#include "gmock/gmock.h"
#include "tests/support/bodies.h"

namespace duet::engine {
namespace {

using test::Puppet;
using testing::Each;
using testing::IsEmpty;
using testing::SizeIs;

motion::Poses Scaled(double size) {
  return test::Changed(
      Puppet(), [size](int, motion::Vec3 joint) { return joint * static_cast<float>(size); });
}

// Pairs whose followers have these sizes; the leaders have 1.
std::vector<double> Ratios(const std::vector<double>& sizes) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  BodyFit fit(skeleton);
  for (const double size : sizes) fit.Add(Scaled(1), Scaled(size));
  return fit.BoneRatios();
}

TEST(BodyFit, FollowersWhoAreSmallerOrLargerHaveRatios) {
  EXPECT_THAT(Ratios({0.9, 0.88, 0.9}), SizeIs(motion::SbuSkeleton().bones.size()));
  EXPECT_THAT(Ratios({0.9, 0.88, 0.9}), Each(testing::DoubleNear(0.9, 1e-3)));
  EXPECT_THAT(Ratios({1.2}), Each(testing::DoubleNear(1.2, 1e-3)));
}

TEST(BodyFit, AnyTwoPeopleHaveNone) {
  EXPECT_THAT(Ratios({}), IsEmpty());
  EXPECT_THAT(Ratios({1, 1, 1}), IsEmpty());
  EXPECT_THAT(Ratios({0.9, 0.9, 0.9, 1.1, 1.1}), IsEmpty());
  EXPECT_THAT(Ratios({0.99}), IsEmpty());
}

}  // namespace
}  // namespace duet::engine
