#include "model/evaluation/report/pose_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "absl/strings/str_split.h"
#include "model/evaluation/report/pose_view.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

PicturedPair Pair(const std::string& name, motion::Vec3 away = {1, 0, 0}) {
  PicturedPair pair = {name, test::SwayingMotion(31, 15), test::SwayingMotion(31, 15)};
  for (motion::Vec3& p : pair.follower.all()) p += away;
  return pair;
}

size_t Count(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(PoseViewTest, LeadersAreOnTheLeftAndUpIsUp) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  for (const motion::Vec3 away : {motion::Vec3{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const PicturedPair pair = Pair("a", away);
    const PoseView view(skeleton, {pair});
    const motion::Vec3 leader = pair.leader.at(0, skeleton.root);
    EXPECT_LT(view.At(leader).x, view.At(leader + away).x);
    EXPECT_GT(view.At(leader).y, view.At(leader + motion::Vec3{0, 1, 0}).y);
  }
}

TEST(PoseViewTest, HoldsEveryFrameOfEveryPair) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::vector<PicturedPair> pairs = {Pair("a"), Pair("b", {3, 1, -2})};
  const PoseView view(skeleton, pairs);
  for (const PicturedPair& pair : pairs) {
    for (const motion::Vec3 position : pair.follower.all()) {
      const Pixel p = view.At(position);
      EXPECT_GT(p.x, 0);
      EXPECT_GT(p.y, 0);
      EXPECT_LT(p.x, view.width());
      EXPECT_LT(p.y, view.height());
    }
  }
}

TEST(StripTest, HasARowAPairAndAColumnAMoment) {
  const std::string svg =
      StripSvg(motion::SbuSkeleton(), "kick", {Pair("captured"), Pair("flow")}, 15, 8);
  EXPECT_THAT(svg, StartsWith("<svg "));
  // Two bodies in two rows of eight, each of four paths, and two floors.
  EXPECT_EQ(Count(svg, "<path "), 2u * 8 * 2 * 4 + 2);
  EXPECT_THAT(svg, HasSubstr(">captured</text>"));
  EXPECT_THAT(svg, HasSubstr(">flow</text>"));
  EXPECT_THAT(svg, HasSubstr(">0.0 s</text>"));
  EXPECT_THAT(svg, HasSubstr(">2.0 s</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("<animate")));
}

TEST(StripTest, AClipOfFewFramesShowsEachOnce) {
  PicturedPair brief = Pair("a");
  brief.leader.Resize(3);
  brief.follower.Resize(3);
  const std::string svg = StripSvg(motion::SbuSkeleton(), "kick", {brief}, 15, 8);
  EXPECT_EQ(Count(svg, " s</text>"), 3u);
}

TEST(MovingTest, EveryBodyMovesThroughEveryFrameAtItsSpeed) {
  const std::string svg = MovingSvg(motion::SbuSkeleton(), "kick", {Pair("captured")}, 15);
  EXPECT_EQ(Count(svg, "<animate "), 2u * 4);
  const size_t values = svg.find("values=\"") + 8;
  const std::string first = svg.substr(values, svg.find('"', values) - values);
  const std::vector<std::string> frames = absl::StrSplit(first, ';');
  EXPECT_EQ(frames.size(), 31u + 7);  // and half a second's hold
  EXPECT_NE(frames[0], frames[15]);
  EXPECT_EQ(frames[30], frames[37]);
  EXPECT_THAT(svg, HasSubstr("dur=\"2.53s\""));  // 38 frames at 15 Hz
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace duet::evaluation::report
