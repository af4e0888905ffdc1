#include "client/capture/frame_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/capture/capture_stream.h"
#include "client/capture/osc.h"
#include "client/capture/rate_estimate.h"
#include "client/capture/rokoko_reader.h"
#include "client/capture/vmc_reader.h"
#include "model/base/random.h"
#include "tests/client/capture/datagrams.h"
#include "tests/support/matchers.h"

namespace duet::client::capture {
namespace {

using Kind = ClockEvent::Kind;
using Source = TimedFrame::Source;

constexpr double kRate = 50, kPeriod = 1 / kRate;

// A joint that moves 1 m in a second, so that its position is the time of a frame.
CaptureFrame FrameAt(double seconds, double sender_ahead = 100) {
  return {seconds + sender_ahead, {{static_cast<float>(seconds), 0, 0}}};
}

class FrameClockTest : public ::testing::Test {
 protected:
  // Sends what was captured at `seconds`, and takes what is due.
  void Arrive(double seconds, double now) {
    clock_.Receive(FrameAt(seconds), now);
    Take(now);
  }
  void ArriveInTime(int first, int last) {
    for (int i = first; i <= last; ++i) Arrive(i * kPeriod, i * kPeriod + 0.005);
  }
  void Take(double now) {
    while (auto frame = clock_.Next(now)) {
      EXPECT_EQ(frame->index, static_cast<int>(frames_.size()));
      frames_.push_back(*std::move(frame));
      taken_at_.push_back(now);
    }
  }
  std::vector<Kind> Events() {
    std::vector<Kind> kinds;
    for (const ClockEvent& event : clock_.TakeEvents()) kinds.push_back(event.kind);
    return kinds;
  }
  double At(std::size_t frame) const { return double{frames_.at(frame).positions[0].x}; }

  FrameClock clock_{{kRate, 0.03, 0.25}};
  std::vector<TimedFrame> frames_;
  std::vector<double> taken_at_;
};

TEST_F(FrameClockTest, PassesFramesOnAsTheyArrive) {
  for (int i = 0; i < 100; ++i) {
    Arrive(i * kPeriod, i * kPeriod + 0.005);
    ASSERT_EQ(frames_.size(), static_cast<std::size_t>(i) + 1);
    EXPECT_NEAR(At(frames_.size() - 1), i * kPeriod, 1e-4);
    EXPECT_NEAR(frames_.back().capture_seconds, i * kPeriod + 0.005, 1e-6);
  }
  EXPECT_THAT(Events(), IsEmpty());
}

TEST_F(FrameClockTest, DropsDuplicates) {
  ArriveInTime(0, 5);
  Arrive(5 * kPeriod, 5 * kPeriod + 0.006);
  ArriveInTime(6, 7);
  EXPECT_EQ(frames_.size(), 8u);
  EXPECT_THAT(Events(), ElementsAre(Kind::kDuplicate));
  EXPECT_EQ(clock_.counts().duplicates, 1);
}

TEST_F(FrameClockTest, PutsFramesBackIntoOrder) {
  ArriveInTime(0, 5);
  Arrive(7 * kPeriod, 0.145);
  EXPECT_EQ(frames_.size(), 6u);  // waits for frame 6
  Arrive(6 * kPeriod, 0.150);
  ASSERT_EQ(frames_.size(), 8u);
  EXPECT_NEAR(At(6), 6 * kPeriod, 1e-5);
  EXPECT_EQ(frames_[6].source, Source::kCaptured);
  EXPECT_THAT(Events(), ElementsAre(Kind::kReordered));
}

TEST_F(FrameClockTest, InterpolatesALostFrameAfterTheTimeForReordering) {
  ArriveInTime(0, 5);
  Arrive(7 * kPeriod, 0.145);
  EXPECT_NEAR(clock_.NextDue(), 0.175, 1e-9);
  Take(0.174);
  EXPECT_EQ(frames_.size(), 6u);
  Take(0.1751);
  ASSERT_EQ(frames_.size(), 8u);
  EXPECT_EQ(frames_[6].source, Source::kInterpolated);
  EXPECT_NEAR(At(6), 6 * kPeriod, 1e-4);
  EXPECT_THAT(Events(), ElementsAre(Kind::kBridged));
  // Too late now.
  Arrive(6 * kPeriod, 0.1755);
  EXPECT_THAT(Events(), ElementsAre(Kind::kLate));
  EXPECT_EQ(frames_.size(), 8u);
}

TEST_F(FrameClockTest, InterpolatesGapsUpToAQuarterOfASecond) {
  ArriveInTime(0, 5);
  Arrive(17 * kPeriod, 17 * kPeriod + 0.005);
  Take(17 * kPeriod + 0.036);
  ASSERT_EQ(frames_.size(), 18u);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    EXPECT_NEAR(At(i), static_cast<double>(i) * kPeriod, 1e-4);
  }
  EXPECT_THAT(Events(), ElementsAre(Kind::kBridged));
  EXPECT_EQ(clock_.counts().bridged_frames, 11);
}

TEST_F(FrameClockTest, HoldsThePoseInLongerGapsAtTheRate) {
  ArriveInTime(0, 5);
  Take(0.105 + 0.27);
  EXPECT_EQ(frames_.size(), 6u);
  for (double now = 0.39; now < 2.1051; now += kPeriod) Take(now);
  // Everything up to now is there, late by the smallest delay at most.
  EXPECT_NEAR(static_cast<double>(frames_.size()), 2.1 * kRate, 2);
  EXPECT_EQ(frames_.back().source, Source::kHeld);
  EXPECT_NEAR(At(frames_.size() - 1), 5 * kPeriod, 1e-5);
  EXPECT_THAT(Events(), ElementsAre(Kind::kHeld));
  ArriveInTime(110, 111);
  EXPECT_THAT(Events(), ElementsAre(Kind::kResumed));
  EXPECT_NEAR(At(frames_.size() - 1), 111 * kPeriod, 1e-4);
  EXPECT_EQ(frames_.size(), 112u);
}

TEST_F(FrameClockTest, FramesAfterALongGapAreUsedThoughTheyAreLaterThanTheSmallestDelay) {
  ArriveInTime(0, 5);
  for (double now = 0.105; now < 2; now += 0.001) Take(now);
  clock_.TakeEvents();
  for (int i = 100; i < 150; ++i) {
    const double arrival = i * kPeriod + 0.012;
    for (double now = arrival - kPeriod + 0.001; now < arrival; now += 0.001) Take(now);
    Arrive(i * kPeriod, arrival);
  }
  EXPECT_THAT(Events(), ElementsAre(Kind::kResumed));
  EXPECT_EQ(frames_.back().source, Source::kCaptured);
  EXPECT_NEAR(At(frames_.size() - 1), 149 * kPeriod, 1e-3);
  EXPECT_EQ(frames_.size(), 150u);
}

TEST_F(FrameClockTest, JitterOfTheNetworkDoesNotReachTheFrames) {
  base::Random random(3);
  std::vector<std::pair<double, double>> arrivals;  // now, captured
  for (int i = 0; i < 500; ++i) {
    const double jitter = static_cast<double>(random.Below(30)) * 1e-3;
    arrivals.emplace_back(i * kPeriod + 0.005 + jitter, i * kPeriod);
  }
  std::sort(arrivals.begin(), arrivals.end());
  for (const auto& [now, captured] : arrivals) {
    while (clock_.NextDue() < now) {
      const std::size_t before = frames_.size();
      Take(clock_.NextDue() + 1e-9);
      if (frames_.size() == before) break;
    }
    Arrive(captured, now);
  }
  Take(11);
  ASSERT_GE(frames_.size(), 500u);
  const double offset = At(100) - 100 * kPeriod;
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_NEAR(At(i), static_cast<double>(i) * kPeriod + offset, 0.002) << i;
  }
  // Whatever the delay of a frame, it was captured the smallest delay before its arrival.
  EXPECT_NEAR(frames_[400].capture_seconds, 400 * kPeriod + 0.005, 0.002);
  EXPECT_EQ(clock_.counts().late, 0);
  EXPECT_EQ(clock_.counts().jumps, 0);
}

TEST_F(FrameClockTest, ResamplesASenderOfAnotherRate) {
  for (int i = 0; i < 300; ++i) Arrive(i / 30.0, i / 30.0 + 0.004);
  EXPECT_NEAR(static_cast<double>(frames_.size()), 299 / 30.0 * kRate, 2);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    EXPECT_NEAR(At(i), static_cast<double>(i) * kPeriod, 0.003);
  }
  EXPECT_THAT(Events(), IsEmpty());
}

TEST_F(FrameClockTest, KeepsStepWithASenderThatIsSlightlyFaster) {
  constexpr double kFaster = kPeriod / 1.001;
  for (int i = 0; i < 5000; ++i) {
    Arrive(i * kFaster, i * kFaster + 0.004);
    ASSERT_EQ(frames_.size(), static_cast<std::size_t>(i) + 1);  // no wait, no frame left out
  }
  EXPECT_THAT(Events(), IsEmpty());
}

TEST_F(FrameClockTest, SetsAClockThatJumpsBackAnew) {
  ArriveInTime(0, 20);
  for (int i = 21; i < 60; ++i) {
    clock_.Receive({i * kPeriod - 50, {{static_cast<float>(i * kPeriod), 0, 0}}},
                   i * kPeriod + 0.005);
    Take(i * kPeriod + 0.005);
  }
  const std::vector<Kind> events = Events();
  EXPECT_EQ(std::count(events.begin(), events.end(), Kind::kClockJumped), 1);
  EXPECT_EQ(clock_.counts().late, 3);  // until the jump is certain
  EXPECT_NEAR(At(frames_.size() - 1), 59 * kPeriod, 1e-3);
  EXPECT_NEAR(static_cast<double>(frames_.size()), 60, 1);
}

TEST_F(FrameClockTest, SetsAClockThatJumpsForwardsAnew) {
  ArriveInTime(0, 20);
  for (int i = 21; i < 60; ++i) {
    clock_.Receive({i * kPeriod + 5000, {{static_cast<float>(i * kPeriod), 0, 0}}},
                   i * kPeriod + 0.005);
    Take(i * kPeriod + 0.005);
  }
  EXPECT_THAT(Events(), ElementsAre(Kind::kClockJumped));
  EXPECT_EQ(frames_.size(), 60u);
}

TEST_F(FrameClockTest, FramesWithoutTimesHaveThatOfTheirArrival) {
  for (int i = 0; i < 100; ++i) {
    const double now = i * kPeriod + (i % 3) * 0.003;
    clock_.Receive({std::nullopt, {{static_cast<float>(i * kPeriod), 0, 0}}}, now);
    Take(now);
  }
  EXPECT_EQ(frames_.size(), 100u);
  EXPECT_THAT(Events(), IsEmpty());
}

TEST_F(FrameClockTest, ATimeThatNeverAdvancesDoesNotStopTheFrames) {
  for (int i = 0; i < 100; ++i) {
    clock_.Receive({7.0, {{static_cast<float>(i * kPeriod), 0, 0}}}, i * kPeriod);
    Take(i * kPeriod);
  }
  EXPECT_GT(frames_.size(), 80u);
  EXPECT_GT(At(frames_.size() - 1), 1.8);
}

// Whatever a sender claims, the output follows the receiver's clock.
TEST_F(FrameClockTest, WildTimesGiveABoundedNumberOfFrames) {
  base::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const double claimed = static_cast<double>(random.Below(2'000'000)) * 1e-3 - 1000;
    clock_.Receive({claimed, {{0, 0, 0}}}, i * kPeriod);
    Take(i * kPeriod);
  }
  EXPECT_LT(frames_.size(), 2000u + 20);
  EXPECT_LE(clock_.TakeEvents().size(), FrameClock::kMaxEvents);
}

TEST(DescribeTest, EveryEventHasWords) {
  for (const Kind kind : {Kind::kDuplicate, Kind::kLate, Kind::kReordered, Kind::kBridged,
                          Kind::kHeld, Kind::kResumed, Kind::kClockJumped}) {
    EXPECT_THAT(Describe({kind, 81, 0.12}), HasSubstr("frame 81"));
  }
}

TEST(RateEstimateTest, FindsUsualRatesInSpiteOfLossAndRounding) {
  for (const double rate : {24.0, 30.0, 60.0, 90.0, 120.0}) {
    RateEstimate estimate;
    for (int i = 0; i <= static_cast<int>(rate) + 8; ++i) {
      if (i % 7 == 3) continue;  // lost
      estimate.Add(std::round(i / rate * 1e3) * 1e-3);
    }
    ASSERT_TRUE(estimate.rate_hz().has_value()) << rate;
    EXPECT_EQ(*estimate.rate_hz(), rate);
  }
}

// A sender of 60 Hz that draws its frames unevenly, as VMC's do: some intervals count as lost
// frames.
TEST(RateEstimateTest, FindsTheUsualRateNearAnUnevenOne) {
  for (const auto& [measured, usual] : {std::pair{62.1, 60.0},
                                        {58.2, 60.0},
                                        {30.9, 30.0},
                                        {24.1, 24.0},
                                        {25.4, 25.0},
                                        {73.9, 75.0},
                                        {64.0, 64.0}}) {
    RateEstimate estimate;
    for (int i = 0; i <= 100; ++i) estimate.Add(i / measured);
    EXPECT_NEAR(estimate.rate_hz().value_or(0), usual, 1e-6) << measured;
  }
}

TEST(RateEstimateTest, HalvesRatesThatAreTooHigh) {
  RateEstimate estimate;
  for (int i = 0; i <= 300; ++i) estimate.Add(i / 240.0);
  EXPECT_EQ(estimate.rate_hz(), 120);
}

TEST(RateEstimateTest, KeepsUnusualRates) {
  RateEstimate estimate;
  for (int i = 0; i <= 60; ++i) estimate.Add(i / 43.0);
  EXPECT_NEAR(estimate.rate_hz().value_or(0), 43, 0.01);
}

TEST(RateEstimateTest, NeedsASecond) {
  RateEstimate estimate;
  for (int i = 0; i < 30; ++i) estimate.Add(i / 60.0);
  EXPECT_EQ(estimate.rate_hz(), std::nullopt);
}

std::unique_ptr<StreamReader> MakeVmcReader() { return std::make_unique<VmcReader>(); }

std::string Hips(float seconds, float height) {
  return test::VmcDatagram({seconds, {{"Hips", {0, height, 0}}}});
}

TEST(CaptureStreamTest, MeasuresTheRateAndThenPassesFramesOn) {
  CaptureStream stream(MakeVmcReader, 0);
  int frames = 0;
  for (int i = 0; i < 120; ++i) {
    stream.Receive(Hips(static_cast<float>(i) / 60, 1), "a", i / 60.0);
    while (stream.Next(i / 60.0)) ++frames;
  }
  EXPECT_EQ(stream.rate_hz(), 60);
  EXPECT_NEAR(frames, 60, 3);
  EXPECT_THAT(stream.Summary(), HasSubstr("120 frames"));
}

TEST(CaptureStreamTest, IgnoresASecondSenderUntilTheFirstIsSilent) {
  CaptureStream stream(MakeVmcReader, 30);
  std::vector<float> heights;
  const auto receive = [&](int i, const char* sender, float height) {
    const double now = i / 30.0;
    stream.Receive(Hips(static_cast<float>(now), height), sender, now);
    while (auto frame = stream.Next(now)) heights.push_back(frame->positions[0].y);
  };
  for (int i = 0; i < 30; ++i) {
    receive(i, "a", 1);
    receive(i, "b", 2);
  }
  EXPECT_EQ(std::count(heights.begin(), heights.end(), 2.0f), 0);
  EXPECT_THAT(stream.TakeNotes(), Contains(HasSubstr("a second sender")));
  for (int i = 150; i < 160; ++i) receive(i, "b", 2);
  EXPECT_EQ(heights.back(), 2.0f);
}

TEST(CaptureStreamTest, FrequentEventsAreOnlyCounted) {
  CaptureStream stream(MakeVmcReader, 30);
  int notes = 0;
  for (int i = 0; i < 300; ++i) {
    const double now = i / 30.0;
    stream.Receive(Hips(static_cast<float>(now), 1), "a", now);
    stream.Receive(Hips(static_cast<float>(now), 1), "a", now);
    while (stream.Next(now)) {
    }
    for (const std::string& note : stream.TakeNotes()) {
      if (note.find("duplicate") != std::string::npos) ++notes;
    }
  }
  EXPECT_EQ(notes, CaptureStream::kMaxNotesOfAKind);
  EXPECT_THAT(stream.Summary(), HasSubstr(" duplicates"));
}

TEST(CaptureStreamTest, SaysOnceWhatItDoesNotUnderstand) {
  CaptureStream stream(MakeVmcReader, 30);
  for (int i = 0; i < 100; ++i) stream.Receive("MXTP02", "a", i);
  EXPECT_THAT(stream.TakeNotes(), ElementsAre(HasSubstr("OSC address")));
  EXPECT_THAT(stream.Summary(), HasSubstr("100 datagrams not understood"));
}

TEST(CaptureStreamTest, SaysOneReasonOnceWhateverItsNumbers) {
  CaptureStream stream([] { return std::make_unique<RokokoReader>(); }, 30);
  for (int i = 0; i < 20; ++i) {
    stream.Receive(absl::StrCat("{\"scene\":{\"actors\":", i, "}}"), "a", i);
  }
  EXPECT_THAT(stream.TakeNotes(), ElementsAre(HasSubstr("scene.actors: expected a list, got 0")));
}

// Within two seconds after the first datagram, also if no other arrives.
TEST(CaptureStreamTest, SaysWhatIsMissingInAStreamWithoutFrames) {
  const std::string bones = test::VmcDatagram({1.0f, {{"mBone", {0, 1, 0}}, {"mBody", {0, 1, 0}}}});
  const auto notes_of = [](const std::string& datagram, auto make_reader) {
    CaptureStream stream(make_reader, 30);
    stream.Receive(datagram, "a", 100);
    EXPECT_EQ(stream.Next(100), std::nullopt);
    EXPECT_LE(stream.NextDue(), 102);
    EXPECT_EQ(stream.Next(stream.NextDue()), std::nullopt);
    const std::vector<std::string> notes = stream.TakeNotes();
    EXPECT_EQ(stream.Next(200), std::nullopt);
    EXPECT_THAT(stream.TakeNotes(), IsEmpty()) << "once";
    return notes;
  };
  const auto warning = HasSubstr("warning: 1 datagram arrived in 1.5 s, but no frame; ");
  EXPECT_THAT(notes_of(bones, MakeVmcReader),
              ElementsAre(AllOf(warning,
                                HasSubstr("VMC: expected /VMC/Ext/Bone/Pos with Unity's "
                                          "bones (Hips, Spine,"),
                                HasSubstr("got only the bones \"mBody\", \"mBone\""))));
  OscBundle other;
  other.Begin("/VMC/Ext/OK", "i");
  other.Add(1);
  EXPECT_THAT(notes_of(other.bytes(), MakeVmcReader),
              ElementsAre(AllOf(warning, HasSubstr("got only \"/VMC/Ext/OK\""))));
  EXPECT_THAT(
      notes_of(R"({"scene":{"actors":[]}})", [] { return std::make_unique<RokokoReader>(); }),
      ElementsAre(AllOf(warning, HasSubstr("an actor with a body"))));
}

TEST(CaptureStreamTest, AStreamWithFramesIsNotSilent) {
  CaptureStream stream(MakeVmcReader, 30);
  for (int i = 0; i < 60; ++i) {
    stream.Receive(Hips(static_cast<float>(i) / 30, 1), "a", i / 30.0);
    while (stream.Next(i / 30.0)) {
    }
  }
  EXPECT_THAT(stream.TakeNotes(), Not(Contains(HasSubstr("no frame"))));
}

}  // namespace
}  // namespace duet::client::capture
