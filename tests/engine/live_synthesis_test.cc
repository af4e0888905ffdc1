#include "model/engine/live_synthesis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using motion::Poses;
using test::FakeSynthesizer;
using test::SwayingMotion;

constexpr int kJoints = 15;
constexpr double kRate = 30;

LiveRequest Request(int delay = 0, double rate = kRate) {
  return {rate, delay, LabelTrack(std::vector<float>(6, 0)), {}, {}, {}};
}

Poses Frames(const Poses& poses, int first, int count) {
  Poses frames(0, poses.joint_count());
  frames.Append(poses.frames(first, count));
  return frames;
}

// A live session whose windows a fake answers at once.
class Session {
 public:
  explicit Session(LiveRequest request = Request())
      : fake_(test::SamplingDescription()), live_(fake_.description(), std::move(request)) {}

  // Sends frames, one by one or together, and takes all that becomes final.
  void Send(const Poses& frames, bool together = false) {
    if (together) {
      live_.AddLeader(frames);
      return Advance();
    }
    for (int t = 0; t < frames.frame_count(); ++t) {
      live_.AddLeader(Frames(frames, t, 1));
      Advance();
    }
  }
  void End() {
    live_.EndLeader();
    Advance();
  }
  void Advance() {
    for (;;) {
      const LiveFrames due = live_.TakeDue();
      if (due.poses.frame_count() > 0) {
        EXPECT_EQ(due.first, live_.next_follower_frame());
        const Poses sent = AsSent(due.poses);
        follower_.Append(sent.all());
        live_.Settle(sent);
      } else if (live_.NeedsWindow()) {
        windows_.push_back(live_.NextWindow());
        live_.Accept(*fake_.Synthesize({&windows_.back()}).front());
      } else {
        return;
      }
    }
  }

  // Rounds frames to multiples of `metres`, as the units of a caller do.
  void RoundTo(float metres) { grid_ = metres; }

  const Poses& follower() const { return follower_; }
  const std::vector<SynthesisWindow>& windows() const { return windows_; }
  LiveSynthesis& live() { return live_; }
  FakeSynthesizer& fake() { return fake_; }

 private:
  Poses AsSent(Poses poses) const {
    if (grid_ == 0) return poses;
    for (motion::Vec3& joint : poses.all()) {
      joint = {std::round(joint.x / grid_) * grid_, std::round(joint.y / grid_) * grid_,
               std::round(joint.z / grid_) * grid_};
    }
    return poses;
  }

  FakeSynthesizer fake_;
  LiveSynthesis live_;
  float grid_ = 0;
  Poses follower_{0, kJoints};
  std::vector<SynthesisWindow> windows_;
};

TEST(LiveSynthesisTest, EveryFrameIsFinalWhenItsDelayHasPassed) {
  for (const double rate : {1.0, 3.0, 8.0, 15.0, 24.0, 30.0, 60.0, 90.0, 240.0}) {
    for (const int delay : {0, 1, 5, 10}) {
      if (delay > 0.5 * rate) continue;
      const Poses leader = SwayingMotion(200, rate);
      Session session(Request(delay, rate));
      for (int t = 0; t < leader.frame_count(); ++t) {
        session.Send(Frames(leader, t, 1));
        ASSERT_EQ(session.follower().frame_count(), std::max(0, t + 1 - delay)) << rate;
      }
      session.End();
      EXPECT_EQ(session.follower().frame_count(), leader.frame_count());
      EXPECT_TRUE(session.live().done());
      EXPECT_EQ(session.live().skipped_frames(), 0);
    }
  }
}

TEST(LiveSynthesisTest, ALeaderThatEndsWithinTheDelayIsAnswered) {
  Session session(Request(/*delay=*/10));
  session.Send(SwayingMotion(4, kRate));
  EXPECT_EQ(session.follower().frame_count(), 0);
  session.End();
  EXPECT_EQ(session.follower().frame_count(), 4);
}

TEST(LiveSynthesisTest, FinalFramesDoNotDependOnTheLeadersFuture) {
  for (const int delay : {0, 3}) {
    const Poses leader = SwayingMotion(120, kRate);
    Poses altered = leader;
    constexpr int kSame = 70;
    for (motion::Vec3& joint : altered.all().subspan(kSame * kJoints)) {
      joint += motion::Vec3{1, 0, 2};
    }
    Session one(Request(delay)), other(Request(delay));
    one.Send(leader);
    other.Send(altered);
    EXPECT_EQ(Frames(one.follower(), 0, kSame - delay), Frames(other.follower(), 0, kSame - delay));
    EXPECT_NE(Frames(one.follower(), 0, kSame - delay + 8),
              Frames(other.follower(), 0, kSame - delay + 8));
  }
}

TEST(LiveSynthesisTest, AResumedSessionContinuesWithTheSameFrames) {
  for (const double rate : {10.0, 15.0, 25.0, 30.0, 72.0}) {
    for (const int delay : {0, 4}) {
      const Poses leader = SwayingMotion(400, rate);
      Session whole(Request(delay, rate));
      whole.Send(leader);
      whole.End();
      for (const int next : {1, 2, 7, 30, 201, 202, 203, 204}) {
        // Frames that were sent and not answered when the connection broke.
        for (const int unanswered : {0, 1, 6}) {
          LiveRequest request = Request(delay, rate);
          request.first_frame = std::max(0, next - whole.live().history_frames());
          request.leader =
              Frames(leader, request.first_frame, next + delay + unanswered - request.first_frame);
          request.follower =
              Frames(whole.follower(), request.first_frame, next - request.first_frame);
          Session resumed(std::move(request));
          resumed.Advance();
          EXPECT_EQ(resumed.follower().frame_count(), unanswered);
          resumed.Send(Frames(leader, next + delay + unanswered, 60));
          const int count = resumed.follower().frame_count();
          EXPECT_EQ(resumed.follower(), Frames(whole.follower(), next, count))
              << rate << " Hz, delay " << delay << ", resumed at " << next;
        }
      }
    }
  }
}

// Indices of frames: each one up to 16, then every 23rd, which meets evaluations at different
// times.
std::vector<int> Indices(int first, int end) {
  std::vector<int> indices;
  for (int i = first; i < end; i += i < 16 ? 1 : 23) indices.push_back(i);
  return indices;
}

// The request of a caller that kept `sent` frames of both motions from frame `first` on, and
// `delay` further frames of the leader.
LiveRequest Resumed(const Poses& leader, double rate, int first, int sent, int delay) {
  LiveRequest request = Request(delay, rate);
  request.first_frame = first;
  request.leader = Frames(leader, first, sent + delay);
  request.follower = Frames(leader, first, sent);
  return request;
}

TEST(LiveSynthesisTest, ASessionResumesFromAHistoryOfAnyLength) {
  for (const double rate : {10.0, 15.0, 24.0, 30.0, 60.0, 90.0, 240.0}) {
    const int two_seconds = static_cast<int>(2 * rate);
    const Poses leader = SwayingMotion(2 * two_seconds + 40, rate);
    for (const int delay : {0, 1, 4, 10}) {
      if (delay > 0.5 * rate) continue;
      for (const int first : Indices(0, two_seconds)) {
        for (const int sent : Indices(1, two_seconds)) {
          Session session(Resumed(leader, rate, first, sent, delay));
          session.Send(Frames(leader, first + sent + delay, 2));
          ASSERT_EQ(session.follower().frame_count(), 2)
              << rate << " Hz, first frame " << first << ", " << sent << " frames, delay " << delay;
          if (sent % 2 == 0) session.Send(Frames(leader, first + sent + delay + 2, 20), true);
          session.End();
          ASSERT_TRUE(session.live().done());
        }
      }
    }
  }
}

TEST(LiveSynthesisTest, AShortHistoryIsContinuedFromItsLastFrame) {
  Poses leader = SwayingMotion(80, kRate);
  LiveRequest request = Resumed(leader, kRate, /*first=*/31, /*sent=*/1, /*delay=*/0);
  for (motion::Vec3& joint : request.follower.all()) joint += motion::Vec3{2, 0, 0};
  const Poses sent = request.follower;
  Session session(std::move(request));
  session.Send(Frames(leader, 32, 1));
  ASSERT_FALSE(session.windows().empty());
  const SynthesisWindow& window = session.windows().front();
  EXPECT_EQ(window.settled[window.settled.frame_count() - 1], sent[0]);
}

TEST(LiveSynthesisTest, FramesDoNotDependOnHowTheyArriveWhenTheCallerRoundsThem) {
  for (const double rate : {30.0, 72.41, 240.0}) {
    const Poses leader = SwayingMotion(240, rate);
    Session one_by_one(Request(/*delay=*/0, rate)), together(Request(/*delay=*/0, rate));
    for (Session* session : {&one_by_one, &together}) session->RoundTo(0.01f);
    one_by_one.Send(leader);
    constexpr int kMessage = 2;  // with at most one evaluation
    for (int t = 0; t < leader.frame_count(); t += kMessage) {
      together.Send(Frames(leader, t, kMessage), /*together=*/true);
    }
    ASSERT_EQ(together.live().skipped_frames(), 0);
    EXPECT_EQ(one_by_one.follower(), together.follower()) << rate;
  }
}

TEST(LiveSynthesisTest, ASessionResumedAtALabelChangeContinuesWithTheSameFrames) {
  const std::vector<float> none(6, 0), hug = {0, 0, 0, 1, 0, 0};
  for (const int delay : {0, 3}) {
    for (const int change : {40, 41, 42, 43}) {
      for (const int ease : {0, 7}) {
        const Poses leader = SwayingMotion(120, kRate);
        Session whole(Request(delay));
        whole.Send(Frames(leader, 0, change + delay));
        whole.live().ChangeLabels(change, ease, hug);
        whole.Send(Frames(leader, change + delay, 120 - change - delay));
        for (int next = change; next < change + 4; ++next) {
          LiveRequest request = Request(delay);
          request.labels = LabelTrack(none);
          request.labels.Change(change, ease, hug);
          request.first_frame = std::max(0, next - whole.live().history_frames());
          request.leader = Frames(leader, request.first_frame, next + delay - request.first_frame);
          request.follower =
              Frames(whole.follower(), request.first_frame, next - request.first_frame);
          Session resumed(std::move(request));
          resumed.Send(Frames(leader, next + delay, 20));
          EXPECT_EQ(resumed.follower(), Frames(whole.follower(), next, 20))
              << "delay " << delay << ", change at " << change << ", resumed at " << next;
        }
      }
    }
  }
}

TEST(LiveSynthesisTest, FinalFramesDoNotDependOnLaterLabels) {
  Session plain;
  LiveRequest request = Request();
  request.labels = LabelTrack(
      std::vector<LabelKeyframe>{{40, std::vector<float>(6, 0)}, {41, {1, 0, 0, 0, 0, 0}}});
  Session announced(std::move(request));
  plain.Send(SwayingMotion(60, kRate));
  announced.Send(SwayingMotion(60, kRate));
  EXPECT_EQ(Frames(plain.follower(), 0, 41), Frames(announced.follower(), 0, 41));
  EXPECT_NE(Frames(plain.follower(), 41, 3), Frames(announced.follower(), 41, 3));
}

TEST(LiveSynthesisTest, OfFramesThatQueueOnlyTheNewestIsEvaluated) {
  Session session;
  session.Send(SwayingMotion(30, kRate));
  const std::size_t before = session.windows().size();
  session.Send(SwayingMotion(5, kRate), /*together=*/true);
  EXPECT_EQ(session.windows().size(), before + 1);
  EXPECT_EQ(session.follower().frame_count(), 35);
  EXPECT_GT(session.live().skipped_frames(), 0);
}

TEST(LiveSynthesisTest, ABacklogBeyondThePlanIsAnsweredPlanByPlan) {
  Session session;
  session.Send(SwayingMotion(30, kRate));
  session.Send(SwayingMotion(300, kRate), /*together=*/true);
  EXPECT_EQ(session.follower().frame_count(), 330);
}

TEST(LiveSynthesisTest, APlanGoesOnFromTheFinalFramesAndComesToRest) {
  Session session;
  session.Send(SwayingMotion(41, kRate));
  EXPECT_EQ(session.live().Plan(60).first, 41);
  const Poses plan = session.live().Plan(60).poses;
  ASSERT_EQ(plan.frame_count(), 60);
  EXPECT_LT(Distance(plan.at(0, 0), session.follower().at(40, 0)), 0.1f);
  EXPECT_EQ(Frames(plan, 0, 5), session.live().Plan(5).poses);
  const auto step = [&plan](int frame) {
    return Distance(plan.at(frame, 0), plan.at(frame - 1, 0));
  };
  for (int frame = 1; frame < 60; ++frame) EXPECT_LT(step(frame), 0.1f) << frame;
  EXPECT_LT(step(59), 1e-4f);
}

TEST(LiveSynthesisTest, WindowsContinueFromTheLastFrames) {
  Session session;
  session.Send(SwayingMotion(200, kRate));
  const SynthesisWindow& window = session.windows().back();
  ASSERT_TRUE(window.start.has_value());
  EXPECT_LE(window.leader.frame_count(), session.fake().description().window_frames);
  // Evaluated at leader frame 199, after frame 198 completed model frame 99; settled are 86 to 93,
  // and 94 to 99 are made anew.
  EXPECT_EQ(window.settled.frame_count(), 8);
  EXPECT_EQ(window.sent.frame_count(), 6);
  EXPECT_EQ(window.options.sampling.first_frame, 86);
  EXPECT_LT(Distance(window.settled.at(7, 0), session.follower().at(186, 0)), 1e-6f);
  EXPECT_LT(Distance(window.sent.at(5, 0), session.follower().at(198, 0)), 1e-6f);
}

TEST(LiveSynthesisTest, WithADelayAPlanMakesTheDelayAnewToo) {
  for (const auto& [delay, anew] : {std::pair(2, 7), {5, 9}, {10, 11}}) {
    Session session(Request(delay));
    session.Send(SwayingMotion(200, kRate));
    const SynthesisWindow& window = session.windows().back();
    EXPECT_EQ(window.settled.frame_count(), 8) << delay;
    EXPECT_EQ(window.sent.frame_count(), anew) << delay;
    EXPECT_LE(window.leader.frame_count(), session.fake().description().window_frames) << delay;
  }
}

TEST(LiveSynthesisTest, ALongDelayLeavesRoomForTheFuture) {
  Session session(Request(/*delay=*/10, /*rate=*/8));
  session.Send(SwayingMotion(60, 8));
  const SynthesisWindow& window = session.windows().back();
  EXPECT_EQ(window.leader.frame_count(), session.fake().description().window_frames);
  EXPECT_GE(window.sent.frame_count(), 6);
  EXPECT_EQ(session.follower().frame_count(), 50);
}

TEST(LiveSynthesisTest, TheUnknownLeaderComesToRestWithItsLimbLengths) {
  Session session;
  Poses walking = SwayingMotion(60, kRate);
  for (int t = 0; t < 60; ++t) {
    for (motion::Vec3& joint : walking[t]) joint.z += 0.05f * static_cast<float>(t);
  }
  session.Send(walking);
  const Poses& leader = session.windows().back().leader;
  const int last = leader.frame_count() - 1;
  const int newest =
      session.windows().back().settled.frame_count() + session.windows().back().sent.frame_count();
  EXPECT_GT(leader.at(newest + 1, 0).z - leader.at(newest, 0).z, 0.03f);
  EXPECT_LT(leader.at(last, 0).z - leader.at(last - 1, 0).z,
            0.5f * (leader.at(newest + 1, 0).z - leader.at(newest, 0).z));
}

// The first window is that of a clip.
TEST(LiveSynthesisTest, LaterWindowsSpecifyHowManyFramesOfTheLeaderAreAGuess) {
  Session session;
  session.Send(SwayingMotion(60, kRate));
  const SynthesisWindow& first = session.windows().front();
  EXPECT_EQ(first.leader.frame_count(), session.fake().description().window_frames);
  EXPECT_EQ(first.hidden_frames, 0);
  const SynthesisWindow& window = session.windows().back();
  const int known = window.settled.frame_count() + window.sent.frame_count();
  EXPECT_GT(window.hidden_frames, 0);
  EXPECT_LE(window.hidden_frames, window.leader.frame_count() - known);
  EXPECT_GE(window.hidden_frames, window.leader.frame_count() - known - 3);
}

// How near the roots come to each other along the floor.
float NearestRoots(const Poses& leader, const Poses& follower, int root) {
  float nearest = HUGE_VALF;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 apart = follower.at(t, root) - leader.at(t, root);
    nearest = std::min(nearest, std::hypot(apart.x, apart.z));
  }
  return nearest;
}

TEST(LiveSynthesisTest, NoFinalFrameStandsInTheLeader) {
  for (const bool cleans_up : {true, false}) {
    LiveRequest request = Request();
    request.options.sampling.variety = 0;
    request.options.clean_up = cleans_up;
    Session session(std::move(request));
    session.fake().answer = [](motion::Vec3 leader, auto) { return leader; };
    const int root = session.fake().description().skeleton.root;
    Poses leader = SwayingMotion(90, kRate);
    for (int t = 0; t < 90; ++t) {  // elsewhere at once, in any phase of the plans
      for (motion::Vec3& joint : leader[t]) joint.x += 0.05f * static_cast<float>(t / 7 % 3);
    }
    session.Send(leader);
    const float nearest = NearestRoots(leader, session.follower(), root);
    if (cleans_up) {
      EXPECT_GT(nearest, 0.169f);
    } else {
      EXPECT_LT(nearest, 0.05f);
    }
  }
}

TEST(LiveSynthesisTest, LabelsChangeFromTheFrameTold) {
  Session session;
  session.Send(SwayingMotion(30, kRate));
  session.live().ChangeLabels(30, 0, {1, 0, 0, 0, 0, 0});
  session.Send(SwayingMotion(10, kRate));
  const SynthesisWindow& window = session.windows().back();  // the last one
  const int begin = static_cast<int>(*window.options.sampling.first_frame);
  EXPECT_EQ(window.labels[static_cast<std::size_t>(14 - begin) * 6], 0);
  EXPECT_EQ(window.labels[static_cast<std::size_t>(15 - begin) * 6], 1);
}

// A person who walks along x at `speed` metres per second, at 30 frames per second.
Poses Walking(float speed) {
  const Poses pose = SwayingMotion(1, 15);
  Poses walking(0, 15);
  for (int t = 0; t < 5; ++t) {
    Poses frame = pose;
    for (motion::Vec3& p : frame.all()) p.x += speed * static_cast<float>(t) / 30;
    walking.Append(frame.all());
  }
  return walking;
}

// How far the root of a walking leader is taken to go after its last known frame.
float WayAfter(float speed, double seconds) {
  const Poses known = Walking(speed);
  const Poses resting = ComeToRest(motion::SbuSkeleton(), known, 30, {seconds});
  const int root = motion::SbuSkeleton().root;
  return resting.at(0, root).x - known.at(4, root).x;
}

TEST(ComeToRest, ALeaderWhoStandsGoesOnStanding) { EXPECT_NEAR(WayAfter(0, 1), 0, 1e-5); }

// 1.3 and 0.3 s are constants of ComeToRest.
TEST(ComeToRest, ALeaderWhoMovesIsFasterAtFirstAndComesToRest) {
  EXPECT_NEAR(WayAfter(1, 0.01), 0.013, 5e-4);
  EXPECT_NEAR(WayAfter(1, 2), 1.3 * 0.3, 1e-3);
  EXPECT_NEAR(WayAfter(1, 60), 1.3 * 0.3, 1e-3);
}

TEST(ComeToRest, OneKnownFrameIsHeld) {
  const Poses known = SwayingMotion(1, 15);
  const Poses resting = ComeToRest(motion::SbuSkeleton(), known, 30, {0.5});
  for (int j = 0; j < 15; ++j) EXPECT_LT(Distance(resting.at(0, j), known.at(0, j)), 1e-4f) << j;
}

}  // namespace
}  // namespace duet::engine
