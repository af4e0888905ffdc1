#include "model/engine/window_plan.h"

#include <algorithm>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::engine {
namespace {

using ::testing::ElementsAre;

TEST(WindowPlan, ShortClipIsOneWindowOfItsOwnLength) {
  for (int frames : {2, 3, 45, 46}) {
    const WindowPlan plan = PlanWindows(frames, 46, CrossFadeOverlap(46));
    EXPECT_EQ(plan.length, frames);
    EXPECT_THAT(plan.starts, ElementsAre(0));
  }
}

TEST(WindowPlan, OneFrameMoreMakesTwoWindows) {
  const WindowPlan plan = PlanWindows(47, 46, CrossFadeOverlap(46));
  EXPECT_EQ(plan.length, 46);
  EXPECT_THAT(plan.starts, ElementsAre(0, 1));
}

TEST(WindowPlan, SpreadsEvenly) {
  // 10 s at 15 Hz: 151 frames, the last start at 105, which 4 steps of at most 31 reach.
  EXPECT_THAT(PlanWindows(151, 46, CrossFadeOverlap(46)).starts, ElementsAre(0, 26, 53, 79, 105));
}

void ExpectCovered(int frames, int longest, int overlap) {
  const WindowPlan plan = PlanWindows(frames, longest, overlap);
  ASSERT_EQ(plan.length, longest);
  ASSERT_EQ(plan.starts.front(), 0);
  ASSERT_EQ(plan.starts.back() + longest, frames);
  int narrowest = longest, widest = 0;
  for (std::size_t k = 1; k < plan.starts.size(); ++k) {
    const int step = plan.starts[k] - plan.starts[k - 1];
    narrowest = std::min(narrowest, step);
    widest = std::max(widest, step);
  }
  ASSERT_GE(narrowest, 1) << frames << " frames by " << longest;
  ASSERT_LE(widest, longest - overlap) << frames << " frames by " << longest;
  ASSERT_LE(widest - narrowest, 1) << frames << " frames by " << longest;
}

TEST(WindowPlan, CoversEveryFrameWithOverlap) {
  for (int longest : {2, 3, 4, 5, 7, 46, 104}) {
    for (int frames = longest + 1; frames < 20 * longest; ++frames) {
      ASSERT_NO_FATAL_FAILURE(ExpectCovered(frames, longest, CrossFadeOverlap(longest)));
      ASSERT_NO_FATAL_FAILURE(ExpectCovered(frames, longest, SettledOverlap(longest)));
    }
  }
}

TEST(WindowPlan, SharesAThirdToCrossFadeAndASixthToGoOn) {
  EXPECT_EQ(CrossFadeOverlap(46), 15);
  EXPECT_EQ(CrossFadeOverlap(104), 34);
  EXPECT_EQ(CrossFadeOverlap(2), 1);
  EXPECT_EQ(SettledOverlap(46), 8);
  EXPECT_EQ(SettledOverlap(104), 17);
  EXPECT_EQ(SettledOverlap(2), 1);
}

TEST(WindowPlan, UsesNoMoreWindowsThanNeeded) {
  for (int frames = 47; frames < 2000; ++frames) {
    const int needed = (frames - 15 + 30) / 31;  // each adds at most 46 - 15 frames
    ASSERT_EQ(static_cast<int>(PlanWindows(frames, 46, CrossFadeOverlap(46)).starts.size()), needed)
        << frames;
  }
}

}  // namespace
}  // namespace duet::engine
