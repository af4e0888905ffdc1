// What the clean-up of a follower costs, by frames of the window.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>

#include "model/cleanup/clean_up.h"
#include "model/motion/skeleton.h"

namespace {

constexpr double kRateHz = 15;
constexpr int kSettled = 15;

// A made-up person who sways at `z`, near enough to the other for the capsules to have work.
duet::motion::Poses Person(int frames, float z) {
  const duet::motion::Skeleton skeleton = duet::motion::SbuSkeleton();
  duet::motion::Poses person(frames, skeleton.joint_count());
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      const float phase = 0.2f * static_cast<float>(t) + static_cast<float>(j);
      person.at(t, j) = {0.2f * std::sin(phase), 1.5f - 0.1f * static_cast<float>(j),
                         z + 0.2f * std::cos(phase)};
    }
  }
  return person;
}

void BM_CleanUp(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  const duet::cleanup::CleanUp clean_up(duet::motion::SbuSkeleton());
  const duet::motion::Poses leader = Person(frames, 0), follower = Person(frames, 0.6f);
  const duet::cleanup::Touch touch(static_cast<std::size_t>(frames), 0);
  for (auto _ : state) {
    duet::motion::Poses cleaned = follower;
    clean_up.Apply(leader, touch, duet::cleanup::Meetings(touch.size(), {1, 0.1f}),
                   {kRateHz, kSettled}, &cleaned);
    benchmark::DoNotOptimize(cleaned);
  }
  state.SetComplexityN(frames);
}
BENCHMARK(BM_CleanUp)
    ->Arg(46)
    ->Arg(92)
    ->Arg(184)
    ->Arg(368)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

// Only the joints' ranges, for a person whose limbs are all outside them.
void BM_JointRanges(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  const duet::motion::Skeleton skeleton = duet::motion::SbuSkeleton();
  const duet::body::Body body = duet::body::FindBody(skeleton);
  const duet::motion::Poses follower = Person(frames, 0.6f);
  for (auto _ : state) {
    duet::motion::Poses limited = follower;
    duet::cleanup::KeepJointRanges(skeleton, body, std::nullopt, {}, {kRateHz, kSettled}, &limited);
    benchmark::DoNotOptimize(limited);
  }
}
BENCHMARK(BM_JointRanges)->Arg(46)->Unit(benchmark::kMicrosecond);

}  // namespace
