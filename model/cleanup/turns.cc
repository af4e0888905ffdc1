#include "model/cleanup/turns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

// The sine of an angle without an axis.
constexpr float kNoAngle = 1e-6f;

Vec3 AnyAcross(Vec3 along) {
  const Vec3 across = Cross(along, std::abs(along.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
  return across / Norm(across);
}

// `from` turned towards `to` by a share of the way, and by at most `most` radians.
Vec3 TurnPart(Vec3 from, Vec3 to, float share, float most) {
  const Vec3 axis = Cross(from, to);
  const float sine = Norm(axis), cosine = Dot(from, to);
  const float way = share * std::atan2(sine, cosine);
  if (share == 1 && way <= most) return to;
  if (sine < kNoAngle && cosine > 0) return to;
  return RotateAbout(from, sine < kNoAngle ? AnyAcross(from) : axis / sine, std::min(way, most));
}

bool HasFastTurn(const Track& track, std::size_t begin, float most) {
  const float least_cosine = std::cos(most);
  for (std::size_t t = begin; t < track.size(); ++t) {
    if (Dot(track[t - 1], track[t]) < least_cosine) return true;
  }
  return false;
}

void TurnLate(std::size_t begin, float most, Track* track) {
  for (std::size_t t = begin; t < track->size(); ++t) {
    (*track)[t] = TurnPart((*track)[t - 1], (*track)[t], 1, most);
  }
}

// `to`, moved to within `most` of `from`.
float StepTowards(float from, float to, float most) {
  return std::clamp(to, from - most, from + most);
}
Vec3 StepTowards(Vec3 from, Vec3 to, float most) {
  const Vec3 way = to - from;
  const float length = Norm(way);
  return length > most ? from + way * (most / length) : to;
}

template <typename Value>
void StepLate(std::size_t begin, float most, std::vector<Value>* track) {
  for (std::size_t t = begin; t < track->size(); ++t) {
    (*track)[t] = StepTowards((*track)[t - 1], (*track)[t], most);
  }
}

template <typename Value>
void LimitStepsOf(int first, float most, std::vector<Value>* track) {
  const std::size_t settled = static_cast<std::size_t>(first);
  const std::size_t begin = std::max<std::size_t>(1, settled);
  std::vector<Value> late = *track;
  StepLate(begin, most, &late);
  if (late == *track) return;
  std::vector<Value> early = *track;
  for (std::size_t t = early.size() - 1; t > settled; --t) {
    early[t - 1] = StepTowards(early[t], early[t - 1], most);
  }
  for (std::size_t t = settled; t < track->size(); ++t) {
    (*track)[t] = late[t] == early[t] ? early[t] : (late[t] + early[t]) / 2;
  }
  StepLate(begin, most, track);
}

}  // namespace

float MostInAFrame(double degrees_per_second, const Timing& timing) {
  return static_cast<float>(base::kRadiansPerDegree * degrees_per_second / timing.frame_rate_hz);
}

void LimitTurns(int first, float most, Track* track) {
  const std::size_t settled = static_cast<std::size_t>(first);
  const std::size_t begin = std::max<std::size_t>(1, settled);
  if (!HasFastTurn(*track, begin, most)) return;
  // Too late, and too early: half-way between them the turn takes time before and after.
  Track late = *track, early = *track;
  TurnLate(begin, most, &late);
  for (std::size_t t = early.size() - 1; t > settled; --t) {
    early[t - 1] = TurnPart(early[t], early[t - 1], 1, most);
  }
  for (std::size_t t = settled; t < track->size(); ++t) {
    (*track)[t] = late[t] == early[t] ? late[t] : TurnPart(late[t], early[t], 0.5f, HUGE_VALF);
  }
  TurnLate(begin, most, track);
}

void LimitSlopes(int first, float most, std::vector<float>* track) {
  LimitStepsOf(first, most, track);
}

void LimitSteps(int first, float most, Track* track) { LimitStepsOf(first, most, track); }

Vec3 TurnTowards(Vec3 from, Vec3 to, float most) { return TurnPart(from, to, 1, most); }

Vec3 Carried(Vec3 from, Vec3 to, Vec3 v) {
  constexpr float kOpposite = -0.999f;
  const float cosine = Dot(from, to);
  if (cosine <= kOpposite) return v;
  // What `v` has along `from` is along `to` afterwards; the rest turns in their plane.
  return v + to * (2 * Dot(from, v)) - (from + to) * (Dot(from + to, v) / (1 + cosine));
}

float SignedAngle(Vec3 a, Vec3 b, Vec3 axis) {
  return std::atan2(Dot(Cross(a, b), axis), Dot(a, b));
}

}  // namespace duet::cleanup
