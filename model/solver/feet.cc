#include "model/solver/feet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/motion/filter.h"
#include "model/motion/poses.h"
#include "model/solver/geometry.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// Noise of a depth camera moves a standing foot by several centimetres a frame: speeds are those of
// a foot that is smoothed over this. Seconds, standard deviation.
constexpr double kNoiseSeconds = 0.1;
// A foot begins to stand below the first speed and height, and to swing above the second ones. m/s
// and metres above the floor.
constexpr double kSlow = 0.3, kFast = 0.6;
constexpr double kLow = 0.08, kHigh = 0.12;
// Of two swinging feet, one stands unless it is faster than this: then the person runs. m/s.
constexpr double kRunning = 1.2;
// A stand is this far below or above the floor, at most. Metres.
constexpr double kBelowFloor = 0.005, kAboveFloor = 0.05;
// Another place of a foot pays if the foot would otherwise stand this far from its own path for
// kPlaceSeconds. Metres; seconds.
constexpr double kPlaceStray = 0.10, kPlaceSeconds = 0.4;
// The time of a step of its own, to another place. Seconds.
constexpr double kStepSeconds = 0.3;

// Frames [begin, end) in which a foot stands at one place.
struct Stand {
  int begin = 0;
  int end = 0;
  Vec3 place;
};

// A foot's state in one frame, smoothed.
struct FootState {
  double speed = 0;
  double height = 0;
  // Below 1 for a foot that may rest; the smaller, the more so.
  double Unrest() const { return speed / kFast + height / kHigh; }
};

std::vector<FootState> StatesOf(const FootPath& foot, double rate, double floor) {
  const motion::Poses smooth = motion::GaussianFilter(motion::Poses(1, foot), kNoiseSeconds * rate);
  const int n = smooth.frame_count();
  std::vector<FootState> states;
  for (int t = 0; t < n; ++t) {
    const int before = std::max(0, t - 1), after = std::min(n - 1, t + 1);
    const double way = Distance(smooth.at(before, 0), smooth.at(after, 0));
    states.push_back(
        {after > before ? way * rate / (after - before) : 0, smooth.at(t, 0).y - floor});
  }
  return states;
}

std::vector<bool> StandsByHysteresis(const std::vector<FootState>& states) {
  std::vector<bool> standing;
  bool now = states[0].speed < (kSlow + kFast) / 2 && states[0].height < kHigh;
  for (const FootState& state : states) {
    now = state.speed < (now ? kFast : kSlow) && state.height < (now ? kHigh : kLow);
    standing.push_back(now);
  }
  return standing;
}

void StandOnOne(const std::array<std::vector<FootState>, 2>& states,
                std::array<std::vector<bool>, 2>* standing) {
  for (std::size_t t = 0; t < states[0].size(); ++t) {
    if ((*standing)[0][t] || (*standing)[1][t]) continue;
    const std::size_t foot = states[0][t].Unrest() <= states[1][t].Unrest() ? 0 : 1;
    (*standing)[foot][t] = states[foot][t].height < kHigh && states[foot][t].speed < kRunning;
  }
}

// Sums of a path along the floor, from which the cost of any constant place follows.
class PlaceCosts {
 public:
  explicit PlaceCosts(const FootPath& foot) : sums_(foot.size() + 1) {
    for (std::size_t t = 0; t < foot.size(); ++t) {
      const double x = foot[t].x, y = foot[t].y, z = foot[t].z;
      const Sums& last = sums_[t];
      sums_[t + 1] = {last.x + x, last.y + y, last.z + z, last.squares + x * x + z * z};
    }
  }
  Vec3 Mean(int begin, int end) const {
    const Sums s = Between(begin, end);
    const double n = end - begin;
    return {static_cast<float>(s.x / n), static_cast<float>(s.y / n), static_cast<float>(s.z / n)};
  }
  // The squared distances from the mean, along the floor.
  double Cost(int begin, int end) const {
    const Sums s = Between(begin, end);
    return s.squares - (s.x * s.x + s.z * s.z) / (end - begin);
  }

 private:
  struct Sums {
    double x = 0, y = 0, z = 0, squares = 0;
  };
  Sums Between(int begin, int end) const {
    const Sums &a = sums_[static_cast<std::size_t>(begin)],
               &b = sums_[static_cast<std::size_t>(end)];
    return {b.x - a.x, b.y - a.y, b.z - a.z, b.squares - a.squares};
  }
  std::vector<Sums> sums_;
};

// The frames in [begin, end) at which the place changes, with both ends: Potts' model, solved
// exactly. `may_change[t]`: whether a place may begin at frame t.
std::vector<int> CutIntoPlaces(const PlaceCosts& costs, int begin, int end,
                               const std::vector<bool>& may_change, double price) {
  const std::size_t n = static_cast<std::size_t>(end - begin);
  std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
  std::vector<int> from(n + 1, 0);
  best[0] = 0;
  for (std::size_t e = 1; e <= n; ++e) {
    for (std::size_t b = 0; b < e; ++b) {
      const int first = begin + static_cast<int>(b);
      if (b > 0 && !may_change[static_cast<std::size_t>(first)]) continue;
      const double cost = best[b] + price + costs.Cost(first, begin + static_cast<int>(e));
      if (cost >= best[e]) continue;
      best[e] = cost;
      from[e] = static_cast<int>(b);
    }
  }
  std::vector<int> cuts = {end};
  for (std::size_t e = n; e > 0; e = static_cast<std::size_t>(from[e])) {
    cuts.push_back(begin + from[e]);
  }
  std::reverse(cuts.begin(), cuts.end());
  return cuts;
}

// Whether the other foot stands for half a step before and after each frame.
std::vector<bool> MayChange(const std::vector<bool>& other_stands, int half) {
  const int n = static_cast<int>(other_stands.size());
  std::vector<bool> may(other_stands.size());
  for (int t = 0; t < n; ++t) {
    bool stands = true;
    for (int s = std::max(0, t - half); s <= std::min(n - 1, t + half); ++s) {
      stands = stands && other_stands[static_cast<std::size_t>(s)];
    }
    may[static_cast<std::size_t>(t)] = stands;
  }
  return may;
}

std::vector<Stand> FindStands(const FootPath& foot, const std::vector<bool>& standing,
                              const std::vector<bool>& may_change, double rate, double floor) {
  const PlaceCosts costs(foot);
  const int half = std::max(1, static_cast<int>(std::lround(kStepSeconds * rate / 2)));
  const double price = kPlaceStray * kPlaceStray * kPlaceSeconds * rate;
  const int n = static_cast<int>(foot.size());
  std::vector<Stand> stands;
  for (int begin = 0; begin < n;) {
    int end = begin;
    while (end < n && standing[static_cast<std::size_t>(end)]) ++end;
    if (end == begin) {
      ++begin;
      continue;
    }
    const std::vector<int> cuts = CutIntoPlaces(costs, begin, end, may_change, price);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      Stand stand{cuts[i], cuts[i + 1], costs.Mean(cuts[i], cuts[i + 1])};
      stand.place.y = static_cast<float>(
          std::clamp<double>(stand.place.y, floor - kBelowFloor, floor + kAboveFloor));
      // A change of place takes half of a step before and after the cut.
      const int middle = (stand.begin + stand.end) / 2;
      if (i > 0) stand.begin = std::min(stand.begin + half, middle);
      if (i + 2 < cuts.size()) stand.end = std::max(stand.end - half, stand.begin + 1);
      stands.push_back(stand);
    }
    begin = end;
  }
  return stands;
}

// A given foot that is slower stands. m/s.
constexpr double kAtRest = 0.1;
// How far a foot may stand from the wanted one before a step pays, metres, as the mean over the
// time in which it would. Seconds.
constexpr float kStray = 0.1f;
constexpr double kStraySeconds = 0.35;
// How far along the floor a foot may stand from below its hip before it steps, and at most after a
// step. Metres.
constexpr float kFarFromHip = 0.25f, kNearHip = 0.18f;
// The longest step that follows the wanted foot. Seconds.
constexpr double kLongestSeconds = 0.7;
// The shortest rest between two steps of a foot. Seconds.
constexpr double kRestSeconds = 0.15;
// A step rises by this share of its length: three of four steps of captured people rise less. A
// higher one bends a knee that people keep straight.
constexpr float kLiftShare = 0.08f;
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
    swing.target = PlaceAt(swing.end);
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
    place.y = std::max(place.y, static_cast<float>(floor_ - kBelowFloor));
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
    place.y =
        static_cast<float>(std::clamp<double>(place.y, floor_ - kBelowFloor, floor_ + kAboveFloor));
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
    swing.target = PlaceAt(swing.end);
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

// The time over which corrections of the height come and go. Seconds.
constexpr double kRiseSeconds = 0.1;
constexpr double kNear = 0.02;
// The weight of frames in which no foot stands.
constexpr double kIdle = 0.1;
// The part of a leg's length that it may reach.
constexpr float kReach = 0.998f;
// Lasting hip heights are at least this, in lengths of the leg. Captured people stand at .96 on
// average, dancers at .92.
constexpr double kLeastHeight = 0.9;
// The body comes down to its standing feet as far as this, in lengths of the leg. A foot that it
// would have to come down further for leaves its place: people who are thrown back lose their stand
// and do not sit down. Captured people's hips are lower in 1 of 1000 frames.
constexpr float kDeepest = 0.7f;
// What is longer than a dip: the deviation of a Gaussian. Seconds.
constexpr double kLastingSeconds = 0.35;

float Stretch(const body::Limb& leg, absl::Span<const Vec3> pose) {
  const float length = body::LengthOf(leg, pose);
  return length > 0 ? Distance(JointAt(pose, leg.upper), JointAt(pose, leg.end)) / length : 1;
}

float MeanLength(const std::vector<body::Limb>& legs, absl::Span<const Vec3> pose) {
  return (body::LengthOf(legs[0], pose) + body::LengthOf(legs[1], pose)) / 2;
}

struct Stature {
  const std::vector<body::Limb>& legs;
  const Footing& footing;
  const Stretches& wanted;
  double frame_rate_hz;
  int given;
  motion::Poses& poses;

  void Run() {
    const std::vector<double> lacks = LastingLacks();
    std::vector<double> weights, wishes;
    for (int t = 0; t < poses.frame_count(); ++t) {
      double weight = 0, sum = 0;
      for (std::size_t leg = 0; leg < 2; ++leg) {
        if (!footing.standing[leg][static_cast<std::size_t>(t)]) continue;
        weight += 1;
        sum += RiseFor(leg, t, std::min(kReach, wanted[leg][static_cast<std::size_t>(t)]));
      }
      const double wish = weight > 0 ? sum / weight : 0;
      weights.push_back(std::max(weight, kIdle));
      wishes.push_back(std::max(wish, lacks[static_cast<std::size_t>(t)]));
    }
    const std::vector<double> rises =
        SmoothCorrection({frame_rate_hz, kRiseSeconds, kNear, given}, weights, wishes);
    for (int t = given; t < poses.frame_count(); ++t) {
      const float rise = std::min(static_cast<float>(rises[static_cast<std::size_t>(t)]), Room(t));
      const float deepest = kDeepest * MeanLength(legs, poses[t]) - HipsAboveFoot(t);
      const float bounded = std::max(rise, std::min(0.0f, deepest));
      for (Vec3& joint : poses[t]) joint.y += bounded;
    }
  }

  // The rise at which a leg is stretched to a share of its length above its planned foot.
  float RiseFor(std::size_t leg, int t, float stretch) const {
    const Vec3 way =
        JointAt(poses[t], legs[leg].upper) - footing.paths[leg][static_cast<std::size_t>(t)];
    const float length = stretch * body::LengthOf(legs[leg], poses[t]);
    return std::sqrt(std::max(0.0f, length * length - way.x * way.x - way.z * way.z)) - way.y;
  }
  // How far the body can rise until a leg is as long as it gets; below 0 if it must come down.
  // A foot that swings need not be reached while the other one stands.
  float Room(int t) const {
    const std::size_t at = static_cast<std::size_t>(t);
    const float left = RiseFor(0, t, kReach), right = RiseFor(1, t, kReach);
    if (footing.standing[0][at] == footing.standing[1][at]) return std::min(left, right);
    return footing.standing[0][at] ? left : right;
  }

  // The height of the hips above the lower planned foot, metres.
  float HipsAboveFoot(int t) const {
    const std::size_t at = static_cast<std::size_t>(t);
    const float hips =
        (JointAt(poses[t], legs[0].upper).y + JointAt(poses[t], legs[1].upper).y) / 2;
    return hips - std::min(footing.paths[0][at].y, footing.paths[1][at].y);
  }

  // How far the hips are below the least lasting height, metres.
  std::vector<double> LastingLacks() const {
    motion::Poses heights(poses.frame_count(), 1);  // in lengths of the leg
    for (int t = 0; t < poses.frame_count(); ++t) {
      const float length = MeanLength(legs, poses[t]);
      heights.at(t, 0).y = length > 0 ? HipsAboveFoot(t) / length : 1;
    }
    heights = motion::GaussianFilter(heights, kLastingSeconds * frame_rate_hz);
    std::vector<double> lacks;
    for (int t = 0; t < poses.frame_count(); ++t) {
      const double lack = kLeastHeight - double{heights.at(t, 0).y};
      lacks.push_back(std::max(0.0, lack) * MeanLength(legs, poses[t]));
    }
    return lacks;
  }
};

}  // namespace

std::array<std::vector<bool>, 2> FindStanding(const std::array<FootPath, 2>& feet,
                                              double frame_rate_hz, double floor) {
  const std::array<std::vector<FootState>, 2> states = {StatesOf(feet[0], frame_rate_hz, floor),
                                                        StatesOf(feet[1], frame_rate_hz, floor)};
  std::array<std::vector<bool>, 2> standing = {StandsByHysteresis(states[0]),
                                               StandsByHysteresis(states[1])};
  StandOnOne(states, &standing);
  return standing;
}

Footing PlanFooting(const std::array<FootPath, 2>& feet, double frame_rate_hz, double floor) {
  const std::array<std::vector<bool>, 2> standing = FindStanding(feet, frame_rate_hz, floor);
  const int half = std::max(1, static_cast<int>(std::lround(kStepSeconds * frame_rate_hz / 2)));
  Footing footing;
  for (const std::size_t foot : {std::size_t{0}, std::size_t{1}}) {
    // The second foot changes its place only while the first one stands at one.
    const std::vector<bool>& other = foot == 0 ? standing[1] : footing.standing[0];
    const std::vector<Stand> stands =
        FindStands(feet[foot], standing[foot], MayChange(other, half), frame_rate_hz, floor);
    footing.paths[foot] = feet[foot];
    footing.standing[foot].assign(feet[foot].size(), false);
    for (const Stand& stand : stands) {
      std::fill(footing.paths[foot].begin() + stand.begin, footing.paths[foot].begin() + stand.end,
                stand.place);
      std::fill(footing.standing[foot].begin() + stand.begin,
                footing.standing[foot].begin() + stand.end, true);
    }
  }
  return footing;
}

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

Stretches MeasureStretches(const std::vector<body::Limb>& legs, const motion::Poses& poses) {
  Stretches stretches;
  for (const body::Limb& leg : legs) {
    stretches.emplace_back();
    for (int t = 0; t < poses.frame_count(); ++t) {
      stretches.back().push_back(Stretch(leg, poses[t]));
    }
  }
  return stretches;
}

void KeepStature(const std::vector<body::Limb>& legs, const Footing& footing,
                 const Stretches& wanted, double frame_rate_hz, int given, motion::Poses* poses) {
  Stature{legs, footing, wanted, frame_rate_hz, given, *poses}.Run();
}

}  // namespace duet::solver
