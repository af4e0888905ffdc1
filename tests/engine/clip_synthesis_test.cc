#include "model/engine/clip_synthesis.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/body/grade.h"
#include "model/body/limbs.h"
#include "model/engine/clips_together.h"
#include "model/engine/windows.h"
#include "model/motion/resample.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using test::FakeAnswer;
using test::FakeDescription;
using test::FakeDraw;
using test::FakeSynthesizer;
using test::SamplingDescription;
using test::SwayingMotion;
using ::testing::ElementsAre;

constexpr int kJoints = 15;

LabelTrack NoLabels() { return LabelTrack(std::vector<float>(6, 0)); }

ClipRequest Request(int frames, double frame_rate_hz, LabelTrack labels = NoLabels()) {
  return {SwayingMotion(frames, frame_rate_hz),
          frame_rate_hz,
          std::move(labels),
          std::nullopt,
          std::nullopt,
          {}};
}

// What one run of a whole clip gave.
struct Outcome {
  motion::Poses follower{0, kJoints};
  std::vector<SynthesisWindow> windows;
  std::vector<int> frames_after;  // that were handed out after each window
};

Outcome RunAll(const FakeSynthesizer& fake, ClipRequest request) {
  ClipSynthesis clip(fake.description(), std::move(request));
  Outcome run;
  while (clip.HasNextWindow()) {
    run.windows.push_back(clip.NextWindow());
    const SynthesisWindow* window = &run.windows.back();
    run.follower.Append(clip.Accept(*fake.Synthesize({window}).front()).all());
    run.frames_after.push_back(run.follower.frame_count());
  }
  return run;
}

// Makes the answer of a fake change from window to window; the first is 1.
void ChangeByWindow(std::function<motion::Vec3(motion::Vec3 leader, int window)> answer,
                    FakeSynthesizer* fake) {
  const auto window = std::make_shared<int>(0);
  fake->on_batch = [=](absl::Span<const SynthesisWindow* const>) { ++*window; };
  fake->answer = [=](motion::Vec3 leader, absl::Span<const float>) {
    return answer(leader, *window);
  };
}

// The answer of a network without a window limit, brought to the caller's rate.
motion::Poses UnwindowedAnswer(const ClipRequest& request, double model_hz) {
  motion::Poses follower = Resample(request.leader, request.frame_rate_hz, model_hz);
  std::vector<float> labels(6);
  for (int t = 0; t < follower.frame_count(); ++t) {
    request.labels.At(t * request.frame_rate_hz / model_hz, labels.data());
    for (motion::Vec3& position : follower[t]) position = FakeAnswer(position, labels);
  }
  motion::Poses out(request.leader.frame_count(), kJoints);
  for (int t = 0; t < out.frame_count(); ++t) {
    SampleCubic(follower, t * model_hz / request.frame_rate_hz, out[t]);
  }
  return out;
}

void ExpectNear(const motion::Poses& got, const motion::Poses& wanted, float tolerance) {
  ASSERT_EQ(got.frame_count(), wanted.frame_count());
  ASSERT_EQ(got.joint_count(), wanted.joint_count());
  for (std::size_t i = 0; i < got.all().size(); ++i) {
    ASSERT_LE(Distance(got.all()[i], wanted.all()[i]), tolerance)
        << "frame " << i / kJoints << ", joint " << i % kJoints;
  }
}

class ClipSynthesisAtRate : public ::testing::TestWithParam<double> {};

TEST_P(ClipSynthesisAtRate, EveryLengthGivesAsManyFiniteFrames) {
  const FakeSynthesizer fake;
  for (int frames = 2; frames <= 200; ++frames) {
    const Outcome run = RunAll(fake, Request(frames, GetParam()));
    ASSERT_EQ(run.follower.frame_count(), frames);
    for (const motion::Vec3& p : run.follower.all()) ASSERT_TRUE(IsFinite(p)) << frames;
    for (const SynthesisWindow& window : run.windows) {
      ASSERT_GE(window.leader.frame_count(), 2);
      ASSERT_LE(window.leader.frame_count(), 46);
      ASSERT_EQ(window.labels.size(), static_cast<std::size_t>(window.leader.frame_count()) * 6);
    }
  }
}

TEST_P(ClipSynthesisAtRate, WindowsLeaveNoSeam) {
  const FakeSynthesizer fake;
  for (int frames : {2, 47, 61, 93, 200, 600}) {
    const ClipRequest request = Request(frames, GetParam());
    ExpectNear(RunAll(fake, request).follower, UnwindowedAnswer(request, 15), 1e-5f);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, ClipSynthesisAtRate,
                         ::testing::Values(1, 15, 24, 29.97, 30, 60, 120, 240));

TEST(ClipSynthesis, KeepsTheNetworksOwnFramesAtItsOwnRate) {
  // Two windows that disagree by 10 m: only where they overlap may anything be mixed.
  FakeSynthesizer fake;
  ChangeByWindow(
      [](motion::Vec3 leader, int window) {
        return leader + motion::Vec3{10.0f * static_cast<float>(window), 0, 0};
      },
      &fake);
  const ClipRequest request = Request(70, 15);
  const Outcome run = RunAll(fake, request);
  ASSERT_EQ(run.windows.size(), 2u);  // frames 0 to 45 and 24 to 69
  const absl::Span<const motion::Vec3> leader = request.leader.all(), got = run.follower.all();
  for (std::size_t i = 0; i < got.size(); ++i) {
    const std::size_t frame = i / kJoints;
    const float x = got[i].x - leader[i].x;
    if (frame < 24) {
      EXPECT_EQ(got[i], (leader[i] + motion::Vec3{10, 0, 0})) << frame;
    } else if (frame > 45) {
      EXPECT_EQ(got[i], (leader[i] + motion::Vec3{20, 0, 0})) << frame;
    } else {
      EXPECT_GT(x, 10) << frame;
      EXPECT_LT(x, 20) << frame;
    }
  }
}

TEST(ClipSynthesis, AHigherRateIsASplineThroughTheBlendedFrames) {
  // What was handed out early must fit what the cross-fade made of the frames behind it.
  const auto run = [](const ClipRequest& request) {
    FakeSynthesizer fake;
    ChangeByWindow(
        [](motion::Vec3 leader, int window) {
          return leader + motion::Vec3{static_cast<float>(window % 3), 0, 0};
        },
        &fake);
    return RunAll(fake, request).follower;
  };
  const motion::Poses slow = run(Request(151, 15)), fast = run(Request(601, 60));
  motion::Poses wanted(601, kJoints);
  for (int t = 0; t < 601; ++t) SampleCubic(slow, t / 4.0, wanted[t]);
  ExpectNear(fast, wanted, 1e-5f);
}

TEST(ClipSynthesis, NeverTakesBackAFrame) {
  // The answer changes completely from window to window, yet a frame that was handed out depends
  // on earlier windows only: a run that is cut short gave the same frames.
  FakeSynthesizer fake;
  ChangeByWindow(
      [](motion::Vec3 leader, int window) { return leader * std::sin(static_cast<float>(window)); },
      &fake);
  const Outcome first = RunAll(fake, Request(300, 60));
  ChangeByWindow([](motion::Vec3 leader,
                    int window) { return leader * (window == 1 ? std::sin(1.0f) : 50.0f); },
                 &fake);
  const Outcome second = RunAll(fake, Request(300, 60));
  const int handed_out = first.frames_after.front();
  ASSERT_GT(handed_out, 0);
  for (int t = 0; t < handed_out; ++t) {
    ASSERT_EQ(first.follower[t], second.follower[t]) << "frame " << t;
  }
  EXPECT_NE(first.follower.at(handed_out + 60, 0), second.follower.at(handed_out + 60, 0));
}

TEST(ClipSynthesis, NextWindowIsTheSameUntilAccepted) {
  const FakeSynthesizer fake;
  ClipSynthesis clip(fake.description(), Request(100, 15));
  const SynthesisWindow a = clip.NextWindow(), b = clip.NextWindow();
  EXPECT_EQ(a.leader, b.leader);
  EXPECT_EQ(a.labels, b.labels);
  clip.Accept(*fake.Synthesize({&a}).front());
  EXPECT_NE(clip.NextWindow().leader, a.leader);
}

TEST(ClipSynthesis, LaterWindowsStartWhereTheEarlierOnesGot) {
  const FakeSynthesizer fake;
  const ClipRequest request = Request(200, 15);
  const Outcome run = RunAll(fake, request);
  const std::vector<int> starts = PlanWindows(200, 46, CrossFadeOverlap(46)).starts;
  ASSERT_EQ(run.windows.size(), starts.size());
  EXPECT_FALSE(run.windows[0].start.has_value());
  for (std::size_t k = 1; k < starts.size(); ++k) {
    ASSERT_TRUE(run.windows[k].start.has_value()) << k;
    const FollowerStart& start = *run.windows[k].start;
    ASSERT_EQ(start.pose.size(), 15u);
    EXPECT_TRUE(run.windows[k].settled.empty()) << "the model does not sample";
    EXPECT_EQ(start.root, start.pose[2]);
    for (int j = 0; j < kJoints; ++j) {
      const motion::Vec3 wanted = FakeAnswer(request.leader.at(starts[k], j), {});
      EXPECT_LT(Distance(start.pose[static_cast<std::size_t>(j)], wanted), 1e-5f)
          << "window " << k << ", joint " << j;
    }
  }
}

// Later windows have the follower's position.
TEST(ClipSynthesis, StartAndPartnerDirectionGoToTheFirstWindow) {
  ClipRequest request = Request(200, 15);
  request.start = FollowerStart{{1, 2, 3}, {}};
  request.partner_direction = motion::Vec3{1, 0, 0};
  const Outcome run = RunAll(FakeSynthesizer(), request);
  EXPECT_EQ(run.windows[0].start.value().root, (motion::Vec3{1, 2, 3}));
  EXPECT_TRUE(run.windows[0].start->pose.empty());
  EXPECT_EQ(run.windows[0].partner_direction, request.partner_direction);
  for (std::size_t k = 1; k < run.windows.size(); ++k) {
    EXPECT_FALSE(run.windows[k].partner_direction.has_value()) << k;
  }
}

TEST(ClipSynthesis, AModelThatTakesNoStartGetsTheDirectionInEveryWindow) {
  for (ModelDescription description : {FakeDescription(), SamplingDescription()}) {
    description.accepts_follower_start = false;
    ClipRequest request = Request(200, 15);
    request.partner_direction = motion::Vec3{1, 0, 0};
    const Outcome run = RunAll(FakeSynthesizer(description), request);
    EXPECT_EQ(run.windows.size(), PlanWindows(200, 46, CrossFadeOverlap(46)).starts.size());
    for (const SynthesisWindow& window : run.windows) {
      EXPECT_FALSE(window.start.has_value());
      EXPECT_TRUE(window.settled.empty());
      EXPECT_EQ(window.partner_direction, request.partner_direction);
    }
  }
}

TEST(ClipSynthesis, LabelsFollowTheirKeyframesAtAnyRate) {
  const FakeSynthesizer fake;
  std::vector<float> none(6, 0), all(6, 0);
  all[3] = 1;
  // Rises over the caller's frames 60 to 120 at 60 Hz: the second second.
  const LabelTrack labels(std::vector<LabelKeyframe>{{60, none}, {120, all}});
  const ClipRequest request = Request(301, 60, labels);
  const Outcome run = RunAll(fake, request);
  for (int frame : {0, 30, 60, 90, 110, 120, 240, 300}) {
    const float wanted = std::min(1.0f, std::max(0.0f, static_cast<float>(frame - 60) / 60));
    EXPECT_NEAR(run.follower.at(frame, 0).y - request.leader.at(frame, 0).y, wanted, 0.02f)
        << frame;
  }
  ExpectNear(run.follower, UnwindowedAnswer(request, 15), 1e-5f);
}

TEST(ClipSynthesis, TenMinutesCostTenMinutesOfFrames) {
  const struct {
    int frames;
    double rate;
  } clips[] = {{144000, 240}, {600, 1}, {9000, 15}};
  for (const auto& clip : clips) {
    FakeSynthesizer fake;
    int windows = 0, network_frames = 0, most_handed_out = 0, handed_out = 0;
    ClipSynthesis synthesis(fake.description(), Request(clip.frames, clip.rate));
    while (synthesis.HasNextWindow()) {
      const SynthesisWindow window = synthesis.NextWindow();
      ++windows;
      network_frames += window.leader.frame_count();
      const int frames = synthesis.Accept(*fake.Synthesize({&window}).front()).frame_count();
      handed_out += frames;
      most_handed_out = std::max(most_handed_out, frames);
    }
    EXPECT_EQ(handed_out, clip.frames);
    // 9001 frames of the network's: each at most half as often again.
    EXPECT_LE(network_frames, 9001 * 3 / 2 + 46) << clip.rate;
    EXPECT_LE(windows, 291) << clip.rate;
    // Nothing piles up for the end: no Accept returns more than a window and the two frames that
    // the spline waited for.
    EXPECT_LE(most_handed_out, 48 * clip.rate / 15 + 1) << clip.rate;
  }
}

TEST(ClipSynthesis, WorksWithTheShortestWindows) {
  for (int longest : {2, 3, 4, 5}) {
    ModelDescription description = FakeDescription();
    description.window_frames = longest;
    const FakeSynthesizer fake(description);
    for (int frames : {2, 3, 10, 50}) {
      const ClipRequest request = Request(frames, 30);
      ExpectNear(RunAll(fake, request).follower, UnwindowedAnswer(request, 15), 1e-5f);
    }
  }
}

class GradeAtRate : public ::testing::TestWithParam<double> {};

TEST_P(GradeAtRate, IsThatOfTheFramesHandedOut) {
  // Leans into the leader and away again, so that some frames overlap and others do not.
  FakeSynthesizer fake;
  ChangeByWindow(
      [](motion::Vec3 leader, int window) {
        return leader + motion::Vec3{0, 0, 0.4f * static_cast<float>(window % 2)};
      },
      &fake);
  const ClipRequest request = Request(static_cast<int>(8 * GetParam()), GetParam());
  std::vector<ClipSynthesis> clips;
  clips.emplace_back(fake.description(), request);
  motion::Poses follower(0, kJoints);
  while (clips.back().HasNextWindow()) {
    EXPECT_FALSE(clips.back().grade().has_value());
    const SynthesisWindow next = clips.back().NextWindow();
    follower.Append(clips.back().Accept(*fake.Synthesize({&next}).front()).all());
    // Moves the clip, which must keep its measures.
    std::vector<ClipSynthesis> moved;
    moved.push_back(std::move(clips.back()));
    clips = std::move(moved);
  }
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const body::Body body = body::FindBody(skeleton);
  body::PairMeter meter(skeleton, body, GetParam());
  body::GradeSum sum;
  for (int t = 0; t < follower.frame_count(); ++t)
    sum.Add(meter.Add(request.leader[t], follower[t]));
  const body::Grade wanted = sum.Get();
  const std::optional<body::Grade> grade = clips.back().grade();
  ASSERT_TRUE(grade.has_value());
  EXPECT_GT(grade->overlapping, 0);
  EXPECT_LT(grade->overlapping, 1);
  EXPECT_EQ(grade->overlapping, wanted.overlapping);
  EXPECT_EQ(grade->twisted, wanted.twisted);
  EXPECT_EQ(grade->skating, wanted.skating);
  EXPECT_EQ(grade->leader_skating, wanted.leader_skating);
  EXPECT_EQ(grade->bad_runs.size(), wanted.bad_runs.size());
}

INSTANTIATE_TEST_SUITE_P(Rates, GradeAtRate, ::testing::Values(15, 29.97, 60, 240));

TEST(ClipSynthesis, HasNoGradeWithoutHips) {
  ModelDescription description = FakeDescription();
  description.skeleton.hips.reset();
  const FakeSynthesizer fake(description);
  ClipSynthesis clip(description, Request(20, 15));
  const SynthesisWindow window = clip.NextWindow();
  clip.Accept(*fake.Synthesize({&window}).front());
  EXPECT_FALSE(clip.HasNextWindow());
  EXPECT_FALSE(clip.grade().has_value());
}

TEST(ClipSynthesis, EveryWindowHasASeedOfItsOwnAndTheRequestsVariety) {
  ClipRequest request = Request(200, 15);
  request.options.sampling = {41, 0.25f};
  const Outcome run = RunAll(FakeSynthesizer(SamplingDescription()), request);
  ASSERT_EQ(run.windows.size(), 6u);  // 192 frames beyond the first 8, 38 a window
  for (std::size_t k = 0; k < run.windows.size(); ++k) {
    EXPECT_EQ(run.windows[k].options.sampling.seed, WindowSeed(41, static_cast<int>(k))) << k;
    EXPECT_EQ(run.windows[k].options.sampling.variety, 0.25f) << k;
  }
}

// Splines shorten the bones of a body that turns about two revolutions a second by a hundredth.
TEST(ClipSynthesis, BonesKeepTheirLengthsBetweenFramesOfTheModel) {
  ClipRequest request = Request(120, 60);
  request.options.clean_up = true;
  for (int t = 1; t < 120; ++t) {
    for (int j = 0; j < kJoints; ++j) {
      request.leader.at(t, j) = RotateY(request.leader.at(0, j), 0.2 * t);
    }
  }
  const Outcome run = RunAll(FakeSynthesizer(), request);
  for (const motion::Bone& bone : motion::SbuSkeleton().bones) {
    const auto length = [&](int t) {
      return Distance(run.follower.at(t, bone.parent), run.follower.at(t, bone.child));
    };
    for (int t = 1; t < 120; ++t) EXPECT_NEAR(length(t), length(0), 1e-4f) << t;
  }
}

// The window that draws a frame: the first one after which no window answers it anew.
int WindowThatSettles(int frame, const std::vector<int>& starts) {
  std::size_t window = 0;
  while (window + 1 < starts.size() && frame >= starts[window + 1] + SettledOverlap(46)) ++window;
  return static_cast<int>(window);
}

TEST(ClipSynthesis, WindowsThatShareMuchSettleLittle) {
  // With 45 of 46 frames settled, the last frame of a follower of 47 frames jumped.
  const Outcome run = RunAll(FakeSynthesizer(SamplingDescription()), Request(47, 15));
  ASSERT_EQ(run.windows.size(), 2u);
  EXPECT_EQ(run.windows[1].leader.frame_count(), 46);
  EXPECT_EQ(run.windows[1].settled.frame_count(), SettledOverlap(46));
}

TEST(ClipSynthesis, AModelThatSamplesGoesOnFromSettledFrames) {
  ClipRequest request = Request(300, 15);
  request.options.sampling = {41, 1};
  const Outcome run = RunAll(FakeSynthesizer(SamplingDescription()), request);
  const std::vector<int> starts = PlanWindows(300, 46, SettledOverlap(46)).starts;
  ASSERT_EQ(run.windows.size(), starts.size());
  EXPECT_TRUE(run.windows[0].settled.empty());
  for (std::size_t k = 1; k < starts.size(); ++k) {
    const SynthesisWindow& window = run.windows[k];
    ASSERT_EQ(window.settled.frame_count(), SettledOverlap(46)) << k;
    EXPECT_EQ(window.settled[0], absl::Span<const motion::Vec3>(window.start->pose)) << k;
    for (int t = 0; t < window.settled.frame_count(); ++t) {
      // What the windows before this one made of the frame is what the caller got.
      ASSERT_LT(Distance(window.settled.at(t, 3), run.follower.at(starts[k] + t, 3)), 1e-5f)
          << "window " << k << ", frame " << t;
    }
  }
}

// The fake draws another place for each window, and answers settled frames as they are: nothing is
// averaged.
TEST(ClipSynthesis, TheNextWindowKeepsSettledFramesAndReplacesTheLookahead) {
  for (const int lookahead : {0, 15}) {
    ModelDescription description = SamplingDescription();
    description.lookahead_frames = lookahead;
    ClipRequest request = Request(300, 15);
    request.options.sampling = {41, 1};
    const Outcome run = RunAll(FakeSynthesizer(description), request);
    const std::vector<int> starts = PlanWindows(300, 46, SettledOverlap(46) + lookahead).starts;
    ASSERT_EQ(run.windows.size(), starts.size());
    for (std::size_t k = 1; k < starts.size(); ++k) {
      EXPECT_GE(starts[k - 1] + 46 - lookahead, starts[k] + SettledOverlap(46)) << k;
      EXPECT_EQ(run.windows[k].settled.frame_count(), SettledOverlap(46)) << k;
    }
    ASSERT_EQ(run.follower.frame_count(), 300);
    for (int t = 0; t < 300; ++t) {
      const motion::Vec3 wanted = FakeAnswer(request.leader.at(t, 0), {}) +
                                  FakeDraw({WindowSeed(41, WindowThatSettles(t, starts)), 1});
      EXPECT_LT(Distance(run.follower.at(t, 0), wanted), 1e-5f) << t;
    }
  }
}

TEST(ClipSynthesisDeathTest, StopsAtAResultOfTheWrongSize) {
  const FakeSynthesizer fake;
  ClipSynthesis clip(fake.description(), Request(100, 15));
  EXPECT_DEATH(clip.Accept(motion::Poses(1, kJoints)), "");
  EXPECT_DEATH(clip.Accept(motion::Poses(46, kJoints - 1)), "");
}

// A model that expects the partner to the right of where the hips face.
ModelDescription DirectedDescription() {
  ModelDescription description = SamplingDescription();
  const auto count = static_cast<std::size_t>(DirectionFeatureCount(description.skeleton));
  std::vector<double> none(count, 0), always = none;
  always.back() = 1;
  static_cast<AngleRegression&>(description.partner_direction.emplace()) = {
      none, std::vector<double>(count, 1), none, always};
  return description;
}

// The partner's direction that a window receives.
motion::Vec3 DirectionTold(const SynthesisWindow& window) {
  return window.partner_direction.value_or(motion::Vec3{0, 0, 0});
}

TEST(ClipSynthesis, EstimatesTheDirectionThatARequestLacks) {
  const FakeSynthesizer fake(DirectedDescription());
  const Outcome run = RunAll(fake, Request(120, 15));
  ASSERT_GT(run.windows.size(), 1u);
  const motion::Poses& leader = run.windows[0].leader;
  const motion::JointPair hips = *fake.description().skeleton.hips;
  motion::Vec3 right = leader.at(0, hips.right) - leader.at(0, hips.left);
  right = right / Norm(right);
  EXPECT_LT(Distance(DirectionTold(run.windows[0]), right), 1e-3f);
  // Later windows use the follower's position.
  for (std::size_t i = 1; i < run.windows.size(); ++i) {
    EXPECT_FALSE(run.windows[i].partner_direction.has_value()) << i;
  }
}

TEST(ClipSynthesis, DirectionOfTheRequestOverridesTheEstimate) {
  const FakeSynthesizer fake(DirectedDescription());
  ClipRequest told = Request(30, 15);
  told.partner_direction = motion::Vec3{1, 0, 2};
  EXPECT_EQ(DirectionTold(RunAll(fake, told).windows[0]), (motion::Vec3{1, 0, 2}));
  ClipRequest started = Request(30, 15);
  started.start = FollowerStart{{0, 1, 3}, {}};
  EXPECT_FALSE(RunAll(fake, started).windows[0].partner_direction.has_value());
}

TEST(LiveClipTest, ClipsOfAnyLengthAreAnsweredTogetherToTheirEnds) {
  const FakeSynthesizer fake(SamplingDescription());
  std::vector<LiveClip> clips;
  for (const int frames : {1, 40, 150})
    clips.emplace_back(fake.description(), Request(frames, 30), 2);
  const auto followers = SynthesizeTogether(fake, &clips);
  ASSERT_TRUE(followers.ok()) << followers.status();
  EXPECT_EQ((*followers)[0].frame_count(), 1);
  EXPECT_EQ((*followers)[1].frame_count(), 40);
  EXPECT_EQ((*followers)[2].frame_count(), 150);
}

TEST(LiveClipTest, AFailureEndsAllClips) {
  FakeSynthesizer fake(SamplingDescription());
  fake.window_status = [](const SynthesisWindow&) { return absl::InternalError("no"); };
  std::vector<LiveClip> clips;
  clips.emplace_back(fake.description(), Request(40, 30), 0);
  EXPECT_TRUE(absl::IsInternal(SynthesizeTogether(fake, &clips).status()));
}

std::vector<float> At(const LabelTrack& track, double frame) {
  std::vector<float> weights(2, -99);
  track.At(frame, weights.data());
  return weights;
}

LabelTrack ThreeKeyframes() {
  return LabelTrack(std::vector<LabelKeyframe>{{10, {1, 0}}, {20, {0, 2}}, {21, {-1, 2}}});
}

TEST(LabelTrack, OneVectorHoldsThroughout) {
  const LabelTrack track(std::vector<float>{1, -0.5f});
  for (double frame : {0.0, 0.25, 7.0, 1e9}) EXPECT_THAT(At(track, frame), ElementsAre(1, -0.5f));
}

TEST(LabelTrack, IsLinearBetweenKeyframesAndHeldBeforeAndAfter) {
  EXPECT_THAT(At(ThreeKeyframes(), 0), ElementsAre(1, 0));
  EXPECT_THAT(At(ThreeKeyframes(), 9.9), ElementsAre(1, 0));
  EXPECT_THAT(At(ThreeKeyframes(), 12.5), ElementsAre(0.75f, 0.5f));
  EXPECT_THAT(At(ThreeKeyframes(), 20), ElementsAre(0, 2));
  EXPECT_THAT(At(ThreeKeyframes(), 20.5), ElementsAre(-0.5f, 2));
  EXPECT_THAT(At(ThreeKeyframes(), 500), ElementsAre(-1, 2));
}

}  // namespace
}  // namespace duet::engine
