#include "model/motion/recorded_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

Clip TwoFrames() {
  Clip clip;
  clip.joint_names = {"hip", "knee", "foot"};
  clip.frame_rate_hz = 30;
  clip.poses = Poses(2, 3);
  return clip;
}

TEST(CheckClipTest, NamesWhatNoWriterCanExpress) {
  EXPECT_THAT(CheckClip("leader", TwoFrames()), IsOk());
  Clip clip = TwoFrames();
  clip.poses = {};
  EXPECT_THAT(CheckClip("leader", clip),
              StatusIs(kInvalid, HasSubstr("leader: expected at least 1 frame, got none")));
  clip = TwoFrames();
  clip.at(1, 2).y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(CheckClip("leader", clip), StatusIs(kInvalid, HasSubstr("leader: frame 1 foot")));
  clip = TwoFrames();
  clip.frame_rate_hz = 0;
  EXPECT_THAT(CheckClip("leader", clip), StatusIs(kInvalid, HasSubstr("frame rate")));
}

TEST(CheckClipTest, RejectsPosesOfAnotherNumberOfJointsThanNames) {
  Clip clip = TwoFrames();
  clip.poses = Poses(2, 1);
  EXPECT_THAT(
      CheckClip("leader", clip),
      StatusIs(kInvalid, HasSubstr("expected poses of 3 joints, one for each name, got 1")));
}

TEST(CheckPairTest, RequiresTheSameJointsFramesAndRate) {
  EXPECT_THAT(CheckPair({TwoFrames(), TwoFrames()}), IsOk());
  ClipPair pair{TwoFrames(), TwoFrames()};
  pair.follower.poses.Resize(1);
  EXPECT_THAT(CheckPair(pair), StatusIs(kInvalid, HasSubstr("of 1 x 3")));
  pair = {TwoFrames(), TwoFrames()};
  pair.follower.frame_rate_hz = 15;
  EXPECT_THAT(CheckPair(pair), StatusIs(kInvalid, HasSubstr("the same joints, frames and rate")));
  pair = {TwoFrames(), TwoFrames()};
  pair.follower.poses = Poses(3, 2);
  EXPECT_THAT(CheckPair(pair), StatusIs(kInvalid, HasSubstr("one for each name, got 2")));
}

}  // namespace
}  // namespace duet::motion
