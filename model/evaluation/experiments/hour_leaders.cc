#include "model/evaluation/experiments/hour_leaders.h"

#include <algorithm>
#include <cmath>

#include "model/evaluation/experiments/long_leaders.h"
#include "model/motion/vec3.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr double kPresentSeconds = 3;
constexpr double kGapSeconds[] = {0.1, 0.2, 0.5, 2, 10, 30};
constexpr double kInterpolatedSeconds = 0.25;

constexpr double kWildTempo = 2.5;             // of the dance that a wild leader dances
constexpr double kStaySeconds = 5;             // of a leader who teleports, at one place
constexpr double kFarthest = 1.5;              // from the origin
constexpr double kGolden = 2.399963229728653;  // radians: places that do not repeat

float Wave(double amplitude, double seconds, double period) {
  return static_cast<float>(amplitude * std::sin(2 * M_PI * seconds / period));
}

// Turns and moves a whole pose.
void Move(absl::Span<Vec3> pose, double yaw, Vec3 to) {
  for (Vec3& p : pose) p = RotateY(p, yaw) + to;
}

Poses Wild(double seconds, double rate) {
  Poses leader = MakeLeader("dance", seconds * kWildTempo, rate / kWildTempo);
  for (int t = 0; t < leader.frame_count(); ++t) {
    const double now = t / rate;
    const double leap = std::max(0.0, std::sin(2 * M_PI * now / 1.7));
    const Vec3 place{Wave(kFarthest, now, 4.3), static_cast<float>(0.4 * leap * leap),
                     Wave(kFarthest, now, 5.9)};
    Move(leader[t], Wave(3, now, 3.1), place);
  }
  return leader;
}

Poses Teleporting(double seconds, double rate) {
  Poses leader = MakeLeader("dance", seconds, rate);
  for (int t = 0; t < leader.frame_count(); ++t) {
    const double stay = std::floor(t / rate / kStaySeconds);
    const double far = kFarthest * std::sqrt(std::fmod(stay * 0.618, 1.0));
    const Vec3 place{static_cast<float>(far * std::cos(stay * kGolden)), 0,
                     static_cast<float>(far * std::sin(stay * kGolden))};
    Move(leader[t], stay * kGolden * 1.7, place);
  }
  return leader;
}

Poses Idle(double seconds, double rate) { return MakeLeader("idle", seconds, rate); }

Poses Absent(double seconds, double rate) {
  return WithGaps(MakeLeader("walk_eight", seconds, rate), rate);
}

struct NamedLeader {
  const char* name;
  Poses (*make)(double seconds, double rate);
};
constexpr NamedLeader kLeaders[] = {
    {"idle", Idle}, {"wild", Wild}, {"absent", Absent}, {"teleporting", Teleporting}};

}  // namespace

const std::vector<std::string>& HourLeaderNames() {
  static const auto& names = *[] {
    auto* all = new std::vector<std::string>;
    for (const NamedLeader& leader : kLeaders) all->push_back(leader.name);
    return all;
  }();
  return names;
}

Poses MakeHourLeader(const std::string& name, double seconds, double frame_rate_hz) {
  const auto* leader = std::find_if(std::begin(kLeaders), std::end(kLeaders),
                                    [&](const NamedLeader& other) { return name == other.name; });
  return leader->make(seconds, frame_rate_hz);
}

Poses WithGaps(const Poses& leader, double frame_rate_hz) {
  Poses sent = leader;
  const auto frames = [&](double seconds) {
    return static_cast<int>(std::lround(seconds * frame_rate_hz));
  };
  int last = frames(kPresentSeconds) - 1;  // before the gap
  for (std::size_t i = 0;; ++i) {
    const double seconds = kGapSeconds[i % std::size(kGapSeconds)];
    const int next = last + frames(seconds) + 1;
    if (next >= leader.frame_count()) return sent;
    for (int t = last + 1; t < next; ++t) {
      const float at = seconds > kInterpolatedSeconds
                           ? 0.0f
                           : static_cast<float>(t - last) / static_cast<float>(next - last);
      for (int j = 0; j < leader.joint_count(); ++j) {
        sent.at(t, j) = Lerp(leader.at(last, j), leader.at(next, j), at);
      }
    }
    last = next + frames(kPresentSeconds) - 1;
  }
}

}  // namespace duet::evaluation::experiments
