#include "model/engine/live_clip.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "model/engine/clips_together.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

ClipRequest Request(int frames) {
  return {test::SwayingMotion(frames, 30), 30, LabelTrack(std::vector<float>(6, 0)), std::nullopt,
          std::nullopt};
}

TEST(LiveClipTest, ClipsOfAnyLengthAreAnsweredTogetherToTheirEnds) {
  const test::FakeSynthesizer fake(test::SamplingDescription());
  std::vector<LiveClip> clips;
  for (const int frames : {1, 40, 150}) clips.emplace_back(fake.description(), Request(frames), 2);
  const auto followers = SynthesizeTogether(fake, &clips);
  ASSERT_TRUE(followers.ok()) << followers.status();
  EXPECT_EQ((*followers)[0].frame_count(), 1);
  EXPECT_EQ((*followers)[1].frame_count(), 40);
  EXPECT_EQ((*followers)[2].frame_count(), 150);
}

TEST(LiveClipTest, AFailureEndsAllClips) {
  test::FakeSynthesizer fake(test::SamplingDescription());
  fake.window_status = [](const SynthesisWindow&) { return absl::InternalError("no"); };
  std::vector<LiveClip> clips;
  clips.emplace_back(fake.description(), Request(40), 0);
  EXPECT_TRUE(absl::IsInternal(SynthesizeTogether(fake, &clips).status()));
}

}  // namespace
}  // namespace duet::engine
