#include "model/solver/footing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "model/motion/filter.h"
#include "model/motion/poses.h"

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
// kStraySeconds. Metres; seconds.
constexpr double kStray = 0.10, kStraySeconds = 0.4;
// The time for moving to another place. Seconds.
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
    if (now) {
      now = state.speed < kFast && state.height < kHigh;
    } else {
      now = state.speed < kSlow && state.height < kLow;
    }
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
  const double price = kStray * kStray * kStraySeconds * rate;
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

}  // namespace duet::solver
