#include "contrib/load/live_schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace duet::contrib::load {
namespace {

std::vector<LiveSchedule::Frame> Frames(const LiveOptions& options, int session, int count) {
  LiveSchedule schedule(options, session, Time());
  std::vector<LiveSchedule::Frame> frames;
  for (int i = 0; i < count; ++i) frames.push_back(schedule.Next());
  return frames;
}

double SecondsOf(Time time) { return ToSeconds(time - Time()); }

TEST(LiveScheduleTest, FramesAreDueAtTheRate) {
  LiveOptions options;
  options.frame_rate_hz = 25;
  const std::vector<LiveSchedule::Frame> frames = Frames(options, 0, 100);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(frames[static_cast<size_t>(i)].index, i);
    EXPECT_NEAR(SecondsOf(frames[static_cast<size_t>(i)].due), i / 25.0, 1e-6);
    EXPECT_FALSE(frames[static_cast<size_t>(i)].lost);
  }
}

TEST(LiveScheduleTest, SessionsAreSpreadOverTheIntervalUnlessInStep) {
  LiveOptions options;
  options.frame_rate_hz = 30;
  options.sessions = 30;  // one session a frame, if only the opening were spread
  const auto phase = [&options](int session) {
    const double frames = SecondsOf(LiveSchedule(options, session, Time()).opens()) * 30 + 1e-5;
    return frames - std::floor(frames);
  };
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(phase(i), i / 30.0, 1e-4) << i;
  options.in_step = true;
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(phase(i), 0, 1e-4) << i;
  EXPECT_GT(SecondsOf(LiveSchedule(options, 29, Time()).opens()), 0.9);
}

TEST(LiveScheduleTest, JitterDelaysFramesButKeepsTheirOrder) {
  LiveOptions options;
  options.conditions.jitter = Seconds(0.08);  // more than two frames
  double most = 0;
  Time last;
  for (const LiveSchedule::Frame& frame : Frames(options, 0, 1000)) {
    const double late = SecondsOf(frame.due) - frame.index / 30.0;
    EXPECT_GE(late, -1e-6);
    EXPECT_LE(late, 0.08);
    EXPECT_GE(frame.due, last);
    last = frame.due;
    most = std::max(most, late);
  }
  EXPECT_GT(most, 0.06);
}

TEST(LiveScheduleTest, LosesAShareOfTheFramesButNeverTheFirst) {
  LiveOptions options;
  options.conditions.loss = 0.2;
  int lost = 0;
  for (int session = 0; session < 20; ++session) {
    const std::vector<LiveSchedule::Frame> frames = Frames(options, session, 100);
    EXPECT_FALSE(frames[0].lost);
    for (const LiveSchedule::Frame& frame : frames) lost += frame.lost ? 1 : 0;
  }
  EXPECT_NEAR(lost / 2000.0, 0.2, 0.03);
}

TEST(LiveScheduleTest, AStallHoldsFramesBackOnceInTheMeasuredTime) {
  LiveOptions options;
  options.warm_up = Seconds(2);
  options.measured = Seconds(5);
  options.conditions.stall = Seconds(0.5);
  const std::vector<LiveSchedule::Frame> frames = Frames(options, 0, 300);
  std::vector<double> held;
  for (const LiveSchedule::Frame& frame : frames) {
    const double late = SecondsOf(frame.due) - frame.index / 30.0;
    if (late > 1e-6) held.push_back(SecondsOf(frame.due));
  }
  EXPECT_NEAR(static_cast<double>(held.size()), 15, 1);  // half a second of frames
  EXPECT_EQ(held.front(), held.back());                  // sent at once
  EXPECT_GE(held.front(), 2.5);
  EXPECT_LE(held.front(), 7);
}

TEST(LiveScheduleTest, TheSeedDecides) {
  LiveOptions options;
  options.conditions.jitter = Seconds(0.01);
  const auto due = [&options](int session) { return Frames(options, session, 10)[9].due; };
  const Time first = due(0);
  EXPECT_EQ(due(0), first);
  EXPECT_NE(due(1), first);
  options.seed = 7;
  EXPECT_NE(due(0), first);
}

}  // namespace
}  // namespace duet::contrib::load
