// What it costs to solve a follower, by frames of the window.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>

#include "model/motion/resample.h"
#include "model/motion/skeleton.h"
#include "model/solver/follower.h"

namespace {

constexpr double kRateHz = 15;
constexpr int kSettled = 15;

// A person who stands at `z`, turned by `yaw` radians, and sways by some centimetres.
duet::motion::Poses StandingPerson(int frames, float z, double yaw) {
  constexpr duet::motion::Vec3 kStanding[] = {
      {0, 1.62f, 0},         {0, 1.42f, 0},         {0, 1.15f, 0},        {0.18f, 1.38f, 0},
      {0.24f, 1.12f, 0.02f}, {0.26f, 0.9f, 0.12f},  {-0.18f, 1.38f, 0},   {-0.24f, 1.12f, 0.02f},
      {-0.26f, 0.9f, 0.12f}, {0.1f, 0.92f, 0},      {0.11f, 0.5f, 0.03f}, {0.11f, 0.08f, 0},
      {-0.1f, 0.92f, 0},     {-0.11f, 0.5f, 0.03f}, {-0.11f, 0.08f, 0}};
  duet::motion::Poses person(frames, duet::motion::SbuSkeleton().joint_count());
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < person.joint_count(); ++j) {
      const float phase = 0.2f * static_cast<float>(t) + static_cast<float>(j);
      const duet::motion::Vec3 sway = {0.02f * std::sin(phase), 0.01f * std::cos(phase),
                                       0.02f * std::cos(0.7f * phase)};
      person.at(t, j) = RotateY(kStanding[j] + sway, yaw) + duet::motion::Vec3{0, 0, z};
    }
  }
  return person;
}

// Joints at random, as no body has them: the most that a window of this length costs. At `z`, near
// enough to the other for the capsules to have work.
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

void Solve(const duet::motion::Poses& leader, const duet::motion::Poses& follower,
           const duet::motion::Pins& pins, benchmark::State& state) {
  const duet::motion::Skeleton skeleton = duet::motion::SbuSkeleton();
  const duet::solver::FollowerSolver solver(skeleton, kRateHz);
  duet::solver::Situation situation{leader};
  situation.given = duet::motion::Part(follower, 0, kSettled);
  situation.rules.assign(static_cast<std::size_t>(leader.frame_count()), {0, 1, 0.1f, 60});
  situation.pins = pins;
  for (auto _ : state) {
    duet::motion::Poses solved = follower;
    const auto person = duet::solver::BodyModel::Measure(skeleton, leader);
    solver.Join(situation.given, &solved);
    solver.Solve(situation, *person, &solved);
    benchmark::DoNotOptimize(solved);
  }
  state.SetComplexityN(leader.frame_count());
}

// Two people who stand 0.6 m apart, face to face.
void BM_SolvePeople(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  Solve(StandingPerson(frames, 0, 0), StandingPerson(frames, 0.6f, 3.14159), {}, state);
}
BENCHMARK(BM_SolvePeople)->Arg(45)->Unit(benchmark::kMicrosecond);

void BM_SolvePoints(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  Solve(Person(frames, 0), Person(frames, 0.6f), {}, state);
}
BENCHMARK(BM_SolvePoints)
    ->Arg(46)
    ->Arg(92)
    ->Arg(184)
    ->Arg(368)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

// One hand in every frame after the settled ones, at scattered places around the shoulder.
void BM_SolveWithPins(benchmark::State& state) {
  constexpr int kFrames = 45, kRightShoulder = 6, kRightHand = 8;
  const duet::motion::Poses follower = StandingPerson(kFrames, 1, 3.14159);
  duet::motion::Pins pins;
  for (int frame = kSettled; frame < kFrames; ++frame) {
    const float phase = 2.4f * static_cast<float>(frame);
    const duet::motion::Vec3 way = {0.4f * std::sin(phase), 0.4f * std::cos(phase),
                                    0.4f * std::sin(1.7f * phase)};
    pins.push_back(
        {kRightHand, static_cast<double>(frame), follower.at(frame, kRightShoulder) + way});
  }
  Solve(StandingPerson(kFrames, 0, 0), follower, pins, state);
}
BENCHMARK(BM_SolveWithPins)->Unit(benchmark::kMicrosecond);

}  // namespace
