#include "model/cleanup/hinge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

// The sine of the smallest bend that shows its plane: 12 degrees.
constexpr float kClearBend = 0.2f;

// A limb in one frame.
struct Hinge {
  // Of the plane, of length 1: a positive turn about it takes the upper bone to the lower one.
  Vec3 normal;
  Vec3 carried;                // the normal of the frame before, carried along with the upper bone
  float sine = 0, cosine = 1;  // of the bend
};

Vec3 AnyAcross(Vec3 along) {
  const Vec3 across = Cross(along, std::abs(along.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
  return across / Norm(across);
}

// `v`, which is across `from`, after the shortest turn that takes `from` to `to`; of length 1.
Vec3 CarriedAcross(Vec3 from, Vec3 to, Vec3 v) {
  v = Carried(from, to, v);
  const Vec3 across = v - to * Dot(to, v);
  const float length = Norm(across);
  return length > kNoDirection ? across / length : AnyAcross(to);
}

std::vector<Hinge> HingesOf(const Track& upper, const Track& lower) {
  std::vector<Hinge> hinges;
  hinges.reserve(upper.size());
  for (std::size_t t = 0; t < upper.size(); ++t) {
    const Vec3 across = Cross(upper[t], lower[t]);
    Hinge hinge;
    hinge.sine = Norm(across);
    hinge.cosine = Dot(upper[t], lower[t]);
    hinge.carried =
        t == 0 ? AnyAcross(upper[0]) : CarriedAcross(upper[t - 1], upper[t], hinges[t - 1].normal);
    const bool clear = hinge.sine > (t == 0 ? kNoDirection : kClearBend);
    hinge.normal = clear ? across / hinge.sine : hinge.carried;
    hinges.push_back(hinge);
  }
  return hinges;
}

// Whether a limit is exceeded from the frame `begin` on; without any angle, which takes longer.
bool Exceeds(const std::vector<Hinge>& hinges, std::size_t begin, float plane, float bend,
             float folded) {
  const float least_cosine = std::cos(plane), most_sine = std::sin(bend);
  const float folded_cosine = std::cos(folded);
  for (std::size_t t = begin; t < hinges.size(); ++t) {
    const Hinge& hinge = hinges[t];
    if (hinge.cosine < folded_cosine) return true;
    if (t == 0) continue;
    const Hinge& before = hinges[t - 1];
    if (Dot(hinge.carried, hinge.normal) < least_cosine) return true;
    const float change = hinge.sine * before.cosine - hinge.cosine * before.sine;
    if (std::abs(change) > most_sine) return true;
  }
  return false;
}

}  // namespace

void LimitHinge(const Track& upper, const HingeLimits& limits, const Timing& timing, Track* lower) {
  const std::vector<Hinge> hinges = HingesOf(upper, *lower);
  const float plane = MostInAFrame(limits.fastest_plane, timing);
  const float bend = MostInAFrame(limits.fastest_bend, timing);
  const float folded = static_cast<float>(base::kRadiansPerDegree * limits.folded);
  const std::size_t settled = static_cast<std::size_t>(timing.settled);
  if (!Exceeds(hinges, settled, plane, bend, folded)) return;
  // How far the plane has turned about the upper bone since the first frame.
  std::vector<float> planes, bends;
  for (std::size_t t = 0; t < hinges.size(); ++t) {
    const Hinge& hinge = hinges[t];
    const float turn = t == 0 ? 0 : SignedAngle(hinge.carried, hinge.normal, upper[t]);
    planes.push_back(t == 0 ? 0 : planes.back() + turn);
    const float angle = std::atan2(hinge.sine, hinge.cosine);
    bends.push_back(t < settled ? angle : std::min(angle, folded));
  }
  const std::vector<float> planes_before = planes, bends_before = bends;
  LimitSlopes(timing.settled, plane, &planes);
  LimitSlopes(timing.settled, bend, &bends);
  for (std::size_t t = settled; t < hinges.size(); ++t) {
    const float turn = planes[t] - planes_before[t];
    const bool opens = hinges[t].cosine < std::cos(folded);
    if (turn == 0 && bends[t] == bends_before[t] && !opens) continue;
    const Vec3 normal = RotateAbout(hinges[t].normal, upper[t], turn);
    (*lower)[t] = RotateAbout(upper[t], normal, bends[t]);
  }
}

}  // namespace duet::cleanup
