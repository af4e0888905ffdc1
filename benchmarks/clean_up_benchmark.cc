// What the clean-up of a follower costs, by frames of the window.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>

#include "model/cleanup/clean_up.h"
#include "model/motion/skeleton.h"

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

void CleanUp(const duet::motion::Poses& leader, const duet::motion::Poses& follower,
             benchmark::State& state) {
  const int frames = leader.frame_count();
  const duet::cleanup::CleanUp clean_up(duet::motion::SbuSkeleton());
  const duet::cleanup::Touch touch(static_cast<std::size_t>(frames), 0);
  for (auto _ : state) {
    duet::motion::Poses cleaned = follower;
    clean_up.Apply(leader, touch, duet::cleanup::Meetings(touch.size(), {1, 0.1f}),
                   {kRateHz, kSettled}, &cleaned);
    benchmark::DoNotOptimize(cleaned);
  }
  state.SetComplexityN(frames);
}

// Two people who stand 0.6 m apart, face to face.
void BM_CleanUpOfPeople(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  CleanUp(StandingPerson(frames, 0, 0), StandingPerson(frames, 0.6f, 3.14159), state);
}
BENCHMARK(BM_CleanUpOfPeople)->Arg(45)->Unit(benchmark::kMicrosecond);

void BM_CleanUp(benchmark::State& state) {
  const int frames = static_cast<int>(state.range(0));
  CleanUp(Person(frames, 0), Person(frames, 0.6f), state);
}
BENCHMARK(BM_CleanUp)
    ->Arg(46)
    ->Arg(92)
    ->Arg(184)
    ->Arg(368)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

constexpr int kFrames = 46, kRightShoulder = 6, kRightHand = 8, kTorso = 2;

// Moves a follower, who stands 1 m from the leader, to pins.
void MoveToPins(const duet::motion::Pins& pins, benchmark::State& state) {
  const duet::motion::Poses leader = StandingPerson(kFrames, 0, 0);
  const duet::motion::Poses follower = StandingPerson(kFrames, 1, 3.14159);
  const duet::cleanup::CleanUp clean_up(duet::motion::SbuSkeleton());
  const duet::cleanup::Touch touch(kFrames, 0);
  const duet::cleanup::Timing timing{kRateHz, kSettled};
  for (auto _ : state) {
    duet::motion::Poses pinned = follower;
    const duet::cleanup::PinnedMotion motion =
        clean_up.ApproachPins(leader, touch, pins, timing, &pinned);
    clean_up.PlacePins(motion, leader, timing, &pinned);
    benchmark::DoNotOptimize(pinned);
  }
}

// `pins` of one hand, a third of a second apart.
void BM_Pins(benchmark::State& state) {
  const duet::motion::Poses follower = StandingPerson(kFrames, 1, 3.14159);
  duet::motion::Pins pins;
  for (int i = 0; i < state.range(0); ++i) {
    const int frame = kSettled + 5 + 5 * i;
    const duet::motion::Vec3 way = {0, 0.3f, -0.1f};
    pins.push_back({kRightHand, static_cast<double>(frame), follower.at(frame, kRightHand) + way});
  }
  MoveToPins(pins, state);
}
BENCHMARK(BM_Pins)->Arg(1)->Arg(5)->Unit(benchmark::kMicrosecond);

// The root 0.3 m aside.
void BM_PinOfTheBody(benchmark::State& state) {
  const duet::motion::Vec3 torso = StandingPerson(kFrames, 1, 3.14159).at(30, kTorso);
  MoveToPins({{kTorso, 30, torso + duet::motion::Vec3{0.3f, 0, 0}}}, state);
}
BENCHMARK(BM_PinOfTheBody)->Unit(benchmark::kMicrosecond);

// One hand in every frame: 31 pins at scattered places around the shoulder.
void BM_PinsOfEveryFrame(benchmark::State& state) {
  const duet::motion::Poses follower = StandingPerson(kFrames, 1, 3.14159);
  duet::motion::Pins pins;
  for (int frame = kSettled; frame < kFrames; ++frame) {
    const float phase = 2.4f * static_cast<float>(frame);
    const duet::motion::Vec3 way = {0.4f * std::sin(phase), 0.4f * std::cos(phase),
                                    0.4f * std::sin(1.7f * phase)};
    pins.push_back(
        {kRightHand, static_cast<double>(frame), follower.at(frame, kRightShoulder) + way});
  }
  MoveToPins(pins, state);
}
BENCHMARK(BM_PinsOfEveryFrame)->Unit(benchmark::kMicrosecond);

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
