#include "model/motion/recorded_motion.h"

#include <limits>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "model/motion/motion_limits.h"
#include "model/motion/poses.h"
#include "model/motion/reading_setting.h"
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

TEST(CheckFrameRate, AcceptsRatesOfCameras) {
  for (const double rate : {0.1, 15.0, 29.97, 1000.0}) {
    EXPECT_THAT(CheckFrameRate("a.csv", rate), IsOk()) << rate;
  }
  for (const double rate : {0.0, -30.0, 1000.1, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(CheckFrameRate("a.csv", rate),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         ::testing::StartsWith(
                             "a.csv: frame rate: expected more than 0 and at most 1000 Hz, got ")))
        << rate;
  }
}

TEST(ParseCoordinate, AcceptsNumbersWithinTheLimit) {
  float value = 0;
  EXPECT_TRUE(ParseCoordinate("-10000000", &value));
  EXPECT_EQ(value, -1e7f);
  EXPECT_TRUE(ParseCoordinate("+2.5", &value));
  EXPECT_EQ(value, 2.5f);
  for (const char* text : {"10000001", "-1e30", "nan", "x", ""}) {
    EXPECT_FALSE(ParseCoordinate(text, &value)) << text;
  }
  EXPECT_EQ(value, 2.5f) << "a refused text leaves the value as it was";
}

TEST(ExpectedCoordinate, NamesTheLimitOfANumberBeyondIt) {
  EXPECT_EQ(ExpectedCoordinate("-1e30"),
            "expected a finite number within +-10000000, got \"-1e30\"");
  for (const char* text : {"nan", "x", "1e999"}) {
    EXPECT_EQ(ExpectedCoordinate(text),
              absl::StrCat("expected a finite number, got \"", text, "\""));
  }
}

TEST(ReadingSetting, IsAttachedToTheError) {
  for (ReadingSetting setting :
       {ReadingSetting::kFrameRate, ReadingSetting::kMetresPerUnit, ReadingSetting::kJointMap}) {
    const absl::Status status = MendedBy(absl::InvalidArgumentError("no"), setting);
    EXPECT_EQ(status.message(), "no");
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(MendingSetting(status), setting);
  }
}

TEST(ReadingSetting, IsAbsentIfNoSettingWouldHelp) {
  EXPECT_EQ(MendingSetting(absl::InvalidArgumentError("no")), std::nullopt);
  absl::Status other = absl::InvalidArgumentError("no");
  other.SetPayload("duet.motion.ReadingSetting", absl::Cord("of a later version"));
  EXPECT_EQ(MendingSetting(other), std::nullopt);
}

// Three frames of two joints, told apart by x.
Poses Six() { return Poses(2, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}}); }

Vec3 X(float x) { return {x, 0, 0}; }

TEST(Poses, GrowAtTheEndAndShrinkAtTheFront) {
  Poses poses(0, 2);
  EXPECT_EQ(poses.joint_count(), 2);
  poses.Append(Six().frames(1, 2));
  poses.Append(Six()[0]);
  EXPECT_THAT(poses.all(), ElementsAre(X(2), X(3), X(4), X(5), X(0), X(1)));
  poses.DropFront(2);
  EXPECT_EQ(poses, Poses(2, {X(0), X(1)}));
  poses.DropFront(1);
  EXPECT_TRUE(poses.empty());
  EXPECT_EQ(poses.joint_count(), 2);
}

}  // namespace
}  // namespace duet::motion
