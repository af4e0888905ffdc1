#include "model/solver/steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "model/solver/geometry.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// A foot higher above the floor than this is raised: it need not lead anywhere. Metres.
constexpr double kHigh = 0.12;
// A given foot that is slower stands. m/s.
constexpr double kAtRest = 0.1;
// How far a foot may stand from the wanted one before a step pays, metres, as the mean over the
// time in which it would. Seconds.
constexpr float kStray = 0.1f;
constexpr double kStraySeconds = 0.35;
// How far along the floor a foot may stand from below its hip before it steps, and at most after a
// step. Metres.
constexpr float kFarFromHip = 0.25f, kNearHip = 0.18f;
// Of a step of its own, and the longest of a step that follows the wanted foot.
constexpr double kStepSeconds = 0.3, kLongestSeconds = 0.7;
// The shortest rest between two steps of a foot. Seconds.
constexpr double kRestSeconds = 0.15;
// A step rises by this share of its length: three of four steps of captured people rise less. A
// higher one bends a knee that people keep straight.
constexpr float kLiftShare = 0.08f;
// How far the height of a standing foot may be below and above the floor. Metres.
constexpr double kBelow = 0.005, kAbove = 0.05;
// Steps shorter than this are none, unless the foot is raised. Metres.
constexpr float kShortest = 0.04f;

class Foot {
 public:
  // `wanted_stands`: in which frames the wanted foot stands.
  Foot(const FootPath& wanted, const FootPath& hip, const std::vector<bool>& wanted_stands,
       int given, double rate, double floor)
      : wanted_(wanted),
        hip_(hip),
        path_(wanted),
        rate_(rate),
        floor_(floor),
        swings_(wanted_stands) {
    standing_.assign(wanted.size(), false);
    swings_.flip();
    Start(given);
  }

  int frames() const { return static_cast<int>(wanted_.size()); }
  bool stands() const { return !step_; }
  const FootPath& path() const { return path_; }
  const std::vector<bool>& standing() const { return standing_; }
  // How much a step at frame `t` is wanted: 0 if not at all.
  double Urge(int t) const {
    if (!stands() || t - since_ < Frames(kRestSeconds)) return 0;
    if (swings_[At(t)] && WantedStep(t)) return 10;
    const double stray = double{Norm(Level(MeanWanted(t, kStraySeconds) - place_))};
    const double left = double{Norm(Level(MeanOf(hip_, t, kStraySeconds) - place_))};
    return std::max(stray > kStray ? stray : 0, left > kFarFromHip ? left : 0);
  }

  void Step(int t) {
    Swing swing{t - 1, t - 1 + static_cast<int>(std::lround(Frames(kStepSeconds))), place_, {}};
    if (swings_[At(t)]) swing.end = std::max(LandingAfter(t), t + 1);
    Aim(&swing);
    step_ = swing;
  }

  // Places the foot in frame `t`.
  void Advance(int t) {
    if (step_ && t >= step_->end) {
      place_ = step_->target;
      since_ = t;
      step_.reset();
    }
    if (!step_) {
      path_[At(t)] = place_;
      standing_[At(t)] = true;
      return;
    }
    const Swing& s = *step_;
    const float u = static_cast<float>(t - s.begin) / static_cast<float>(s.end - s.begin);
    const float eased = u * u * (3 - 2 * u), leaving = u * (1 - u) * (1 - u);
    const Vec3 from = s.from - Wanted(s.begin), to = s.target - Wanted(s.end);
    const float frames = static_cast<float>(s.end - s.begin);
    Vec3 place = Wanted(t) + Lerp(from, to, eased) + s.velocity * (leaving * frames);
    if (s.arches) {
      const float arch = kLiftShare * Norm(Level(s.target - s.from));
      const float base = s.from.y + (s.target.y - s.from.y) * eased;
      place.y = std::max(place.y, base + arch * 4 * u * (1 - u));
    }
    place.y = std::max(place.y, static_cast<float>(floor_ - kBelow));
    path_[At(t)] = place;
  }

 private:
  struct Swing {
    int begin = 0, end = 0;  // the frames before and after it
    Vec3 from, target;
    Vec3 velocity = {};  // at its begin, beyond that of the wanted foot; metres a frame
    bool arches = true;
  };

  static std::size_t At(int t) { return static_cast<std::size_t>(t); }
  double Frames(double seconds) const { return seconds * rate_; }
  Vec3 Wanted(int t) const { return wanted_[At(std::clamp(t, 0, frames() - 1))]; }

  // The first frame from `t` on in which the wanted foot stands again.
  int LandingAfter(int t) const {
    const int latest = t + static_cast<int>(std::lround(Frames(kLongestSeconds)));
    while (t < std::min(frames(), latest) && swings_[At(t)]) ++t;
    return t;
  }
  Vec3 MeanWanted(int t, double seconds) const {
    const int end = std::min(frames(), t + std::max(1, static_cast<int>(Frames(seconds))));
    Vec3 sum;
    int count = 0;
    for (int s = std::min(t, frames() - 1); s < end; ++s) {
      if (count > 0 && swings_[At(s)]) break;
      sum += Wanted(s);
      ++count;
    }
    return sum / static_cast<float>(std::max(1, count));
  }
  Vec3 MeanOf(const FootPath& path, int t, double seconds) const {
    const int end = std::min(frames(), t + std::max(1, static_cast<int>(Frames(seconds))));
    Vec3 sum;
    for (int s = std::min(t, end - 1); s < end; ++s) sum += path[At(s)];
    return sum / static_cast<float>(std::max(1, end - std::min(t, end - 1)));
  }
  // A place for the foot from frame `t` on: where it is wanted, but not far from its hip.
  Vec3 PlaceAt(int t) const {
    const Vec3 wanted = MeanWanted(t, kStraySeconds);
    const Vec3 hip = MeanOf(hip_, t, kStraySeconds);
    const Vec3 way = Level(wanted - hip);
    const float far = Norm(way);
    return OnFloor(far > kNearHip ? wanted - way * (1 - kNearHip / far) : wanted);
  }
  Vec3 OnFloor(Vec3 place) const {
    place.y = static_cast<float>(std::clamp<double>(place.y, floor_ - kBelow, floor_ + kAbove));
    return place;
  }
  // Whether the wanted foot's swing at `t` leads somewhere, or is raised.
  bool WantedStep(int t) const {
    const int end = LandingAfter(t);
    if (Norm(Level(MeanWanted(end, kStraySeconds) - place_)) > kShortest) return true;
    for (int s = t; s < end; ++s) {
      if (Wanted(s).y - floor_ > kHigh) return true;
    }
    return false;
  }
  void Aim(Swing* swing) const { swing->target = PlaceAt(swing->end); }

  void Start(int given) {
    if (given == 0) {
      place_ = PlaceAt(0);
      if (!swings_[0]) return;
      Step(1);
      step_->from = Wanted(0);
      path_[0] = Wanted(0);
      return;
    }
    place_ = wanted_[At(given - 1)];
    since_ = given - 1 - static_cast<int>(Frames(kRestSeconds));
    const auto moves = [&](int t) {
      return double{Distance(wanted_[At(t)], wanted_[At(t - 1)])} * rate_ > kAtRest;
    };
    int begin = given - 1;
    while (begin > 0 && moves(begin)) --begin;
    for (int t = begin; t > 0 && t > given - 1 - Frames(kRestSeconds); --t) {
      if (moves(t)) since_ = std::max(since_, t);
    }
    const bool high = double{place_.y} - floor_ > kHigh;
    if (begin == given - 1 && !high) return;
    Swing swing{given - 1, begin + static_cast<int>(std::lround(Frames(kStepSeconds))), place_, {}};
    if (swings_[At(given)]) swing.end = LandingAfter(given);
    swing.end = std::max(swing.end, given + 1);
    if (given > 1) {
      swing.velocity =
          (wanted_[At(given - 1)] - wanted_[At(given - 2)]) - (Wanted(given) - Wanted(given - 1));
    }
    swing.arches = false;
    Aim(&swing);
    step_ = swing;
  }

  const FootPath& wanted_;
  const FootPath& hip_;
  FootPath path_;
  double rate_, floor_;
  std::vector<bool> swings_;    // whether the wanted foot does
  std::vector<bool> standing_;  // whether the planned one does
  std::optional<Swing> step_;
  Vec3 place_;
  int since_ = -1000;
};

}  // namespace

Footing PlanSteps(const std::array<FootPath, 2>& wanted, const std::array<FootPath, 2>& hips,
                  int given, double frame_rate_hz, double floor) {
  const std::array<std::vector<bool>, 2> stands = FindStanding(wanted, frame_rate_hz, floor);
  std::array<Foot, 2> feet = {Foot(wanted[0], hips[0], stands[0], given, frame_rate_hz, floor),
                              Foot(wanted[1], hips[1], stands[1], given, frame_rate_hz, floor)};
  for (int t = given; t < feet[0].frames(); ++t) {
    if (t > 0) {
      const std::size_t at = static_cast<std::size_t>(t);
      const std::array<double, 2> urges = {feet[0].Urge(t), feet[1].Urge(t)};
      const std::size_t first = urges[0] >= urges[1] ? 0 : 1;
      for (const std::size_t foot : {first, 1 - first}) {
        const bool jumps = !stands[0][at] && !stands[1][at];
        if (urges[foot] > 0 && (feet[1 - foot].stands() || jumps)) feet[foot].Step(t);
      }
    }
    for (Foot& foot : feet) foot.Advance(t);
  }
  return {{feet[0].path(), feet[1].path()}, {feet[0].standing(), feet[1].standing()}};
}

}  // namespace duet::solver
