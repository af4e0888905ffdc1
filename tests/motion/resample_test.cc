#include "model/motion/resample.h"

#include <cmath>
#include <vector>

#include "gmock/gmock.h"
#include "model/motion/filter.h"
#include "tests/support/status_matchers.h"

namespace duet::motion {
namespace {

// Two joints: one that moves by a rule of time, one that stands.
Poses Motion(int frames, double hz, Vec3 (*rule)(float)) {
  Poses motion(frames, 2);
  for (int t = 0; t < frames; ++t) {
    motion.at(t, 0) = rule(static_cast<float>(t / hz));
    motion.at(t, 1) = {7, 8, 9};
  }
  return motion;
}

Vec3 Line(float s) { return {s, 2 - s, 3 * s}; }
Vec3 Parabola(float s) { return {s * s, 1, -s * s + s}; }
Vec3 Wave(float s) { return {std::sin(3 * s), std::cos(2 * s), 0}; }

using Sampler = void (*)(const Poses&, double, absl::Span<Vec3>);

Vec3 At(Sampler sampler, const Poses& motion, double frame) {
  Vec3 out[2];
  sampler(motion, frame, absl::MakeSpan(out));
  EXPECT_LT(Distance(out[1], {7, 8, 9}), 1e-5f) << "the other joint";
  return out[0];
}

class EverySampler : public ::testing::TestWithParam<Sampler> {};
INSTANTIATE_TEST_SUITE_P(Resample, EverySampler, ::testing::Values(SampleLinear, SampleCubic));

TEST_P(EverySampler, HitsWholeFramesExactly) {
  const Poses motion = Motion(9, 15, Wave);
  for (int t = 0; t < 9; ++t) {
    EXPECT_EQ(At(GetParam(), motion, t), motion.at(t, 0)) << t;
  }
}

TEST_P(EverySampler, HoldsBothEnds) {
  const Poses motion = Motion(3, 15, Wave);
  EXPECT_EQ(At(GetParam(), motion, -5), motion.at(0, 0));
  EXPECT_EQ(At(GetParam(), motion, 2.001), motion.at(2, 0));
  EXPECT_EQ(At(GetParam(), motion, 1e9), motion.at(2, 0));
}

TEST_P(EverySampler, FollowsALine) {
  const Poses motion = Motion(9, 10, Line);
  // The spline's ends are held, so it bends in the first and the last interval.
  for (double frame = 1; frame <= 7; frame += 0.13) {
    EXPECT_LT(Distance(At(GetParam(), motion, frame), Line(static_cast<float>(frame / 10))), 1e-5f)
        << frame;
  }
}

TEST(SampleCubic, FollowsAParabola) {
  const Poses motion = Motion(9, 10, Parabola);
  for (double frame = 1; frame <= 7; frame += 0.13) {
    EXPECT_LT(Distance(At(SampleCubic, motion, frame), Parabola(static_cast<float>(frame / 10))),
              1e-5f)
        << frame;
  }
}

TEST(ResampledFrameCount, CoversTheWholeDuration) {
  EXPECT_EQ(ResampledFrameCount(46, 15, 15), 46);
  EXPECT_EQ(ResampledFrameCount(31, 30, 15), 16);
  EXPECT_EQ(ResampledFrameCount(32, 30, 15), 17);  // the end lies between two frames
  EXPECT_EQ(ResampledFrameCount(16, 15, 30), 31);
  EXPECT_EQ(ResampledFrameCount(2, 240, 15), 2);  // never fewer than two
  EXPECT_EQ(ResampledFrameCount(2, 1e9, 15), 2);
  EXPECT_EQ(ResampledFrameCount(2, 1, 240), 241);
  EXPECT_EQ(ResampledFrameCount(144000, 240, 15), 9001);
}

TEST(ResampledFrameCount, RoundingAddsNoFrame) {
  for (double hz : {23.976, 24.0, 29.97, 59.94, 100.0 / 3}) {
    for (int frames = 2; frames < 3000; ++frames) {
      ASSERT_EQ(ResampledFrameCount(frames, hz, hz), frames) << hz;
      ASSERT_EQ(ResampledFrameCount(frames, hz, 2 * hz), 2 * frames - 1) << hz;
    }
  }
}

TEST(Resample, SamplesEveryFrame) {
  const Poses motion = Motion(31, 30, Line);
  const Poses out = Resample(motion, 30, 24);
  ASSERT_EQ(out.frame_count(), 25);
  for (int t = 0; t < 25; ++t) {
    EXPECT_LT(Distance(out.at(t, 0), Line(static_cast<float>(t) / 24)), 1e-5f) << t;
  }
}

TEST(ResampleByRate, EndsWithinTheMotion) {
  Clip clip{{"a", "b"}, 30, Motion(32, 30, Line)};
  ASSERT_THAT(ResampleByRate("rate", 15, &clip), test::IsOk());
  EXPECT_EQ(clip.frame_rate_hz, 15);
  ASSERT_EQ(clip.frame_count(), 16);  // the end lies between two frames
  EXPECT_LT(Distance(clip.at(15, 0), Line(1)), 1e-5f);
  ASSERT_THAT(ResampleByRate("rate", 0.5, &clip), test::IsOk());
  EXPECT_EQ(clip.frame_count(), 1);
}

TEST(ResampleByRate, RejectsRatesThatNoMotionHas) {
  Clip clip{{"a", "b"}, 1, Motion(1000, 1, Line)};
  EXPECT_THAT(ResampleByRate("rate", 2000, &clip),
              test::StatusIs(absl::StatusCode::kInvalidArgument,
                             ::testing::HasSubstr("rate: frame rate: expected more than 0")));
  EXPECT_THAT(ResampleByRate("rate", 1000, &clip),
              test::StatusIs(absl::StatusCode::kInvalidArgument,
                             "rate: expected at most 200000 frames, got 999001 at 1000 Hz"));
  EXPECT_EQ(clip.frame_count(), 1000);
}

// One joint that is at `x` frame after frame.
Poses Along(const std::vector<float>& x) {
  Poses poses(static_cast<int>(x.size()), 1);
  for (size_t t = 0; t < x.size(); ++t) poses.at(static_cast<int>(t), 0) = {x[t], 1, -x[t]};
  return poses;
}

TEST(GaussianFilterTest, SteadyMotionStays) {
  const Poses steady = Along({0, 2, 4, 6, 8, 10, 12, 14, 16, 18});
  const Poses smooth = GaussianFilter(steady, 1);
  for (int t = 0; t < 10; ++t) {
    EXPECT_NEAR(smooth.at(t, 0).x, steady.at(t, 0).x, 1e-5) << t;
    EXPECT_NEAR(smooth.at(t, 0).y, 1, 1e-6) << t;
  }
}

TEST(GaussianFilterTest, ImpulseBecomesTheKernel) {
  const Poses smooth = GaussianFilter(Along({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}), 1);
  double sum = 0;
  for (int i = -3; i <= 3; ++i) sum += std::exp(-0.5 * i * i);
  for (int t = 0; t < 11; ++t) {
    const int i = t - 5;
    EXPECT_NEAR(smooth.at(t, 0).x, std::abs(i) > 3 ? 0 : std::exp(-0.5 * i * i) / sum, 1e-6) << t;
  }
}

TEST(GaussianFilterTest, ClipShorterThanTheKernelIsSmoothed) {
  const Poses smooth = GaussianFilter(Along({0, 1}), 2);
  ASSERT_EQ(smooth.frame_count(), 2);
  EXPECT_NEAR(smooth.at(0, 0).x, 0, 1e-6);
  EXPECT_NEAR(smooth.at(1, 0).x, 1, 1e-6);
  EXPECT_EQ(GaussianFilter(Along({5}), 2), Along({5}));
}

TEST(WithoutNoiseTest, FiltersTheSameTimeAtEveryRate) {
  // A jump of 1 m in the middle of 2 s: what is left of it 0.1 s before, at 15 and at 60 Hz.
  for (const int rate : {15, 60}) {
    Poses jump(2 * rate, 1);
    for (int t = rate; t < 2 * rate; ++t) jump.at(t, 0) = {1, 0, 0};
    const float before = WithoutNoise(jump, rate).at(rate - rate / 5, 0).x;
    EXPECT_NEAR(before, 0.03, 0.02) << rate;
    EXPECT_GT(before, 0.005) << rate;
  }
}

}  // namespace
}  // namespace duet::motion
