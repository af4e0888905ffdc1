#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "model/base/angle.h"
#include "model/motion/slope_evidence.h"

namespace duet::motion {
namespace {

// A foot rests while its mean positions over this time move slower than this.
constexpr double kRestSeconds = 0.2;
constexpr double kRestSpeed = 0.2;  // m/s
// Rests of a foot in a square of this size are one place.
constexpr double kPlaceMetres = 0.25;
// The scatter of the heights of places that is expected before any is seen, metres, and its weight
// in places. Professional captures scatter by 2 cm, Kinect's by 6.
constexpr double kExpectedScatter = 0.06;
constexpr double kExpectedWeight = 4;
// The error of the slope however many places there are: this at the scatter of a professional
// capture, and four times as much at twice the scatter
// (docs/decisions/captures.md).
constexpr double kLeastError = 1 * base::kRadiansPerDegree;
constexpr double kCleanScatter = 0.02;
constexpr int kFitSteps = 10;
constexpr double kReach = 2;  // standard deviations with full weight (Huber)
// Square metres. Keeps the slope of places on a line finite, with a large error.
constexpr double kLeastSpread = 1e-6;

// The mean positions of a foot over kRestSeconds each.
std::vector<Vec3> MeanPositions(const Clip& clip, int foot) {
  const int window = std::max(1, static_cast<int>(std::lround(kRestSeconds * clip.frame_rate_hz)));
  std::vector<Vec3> means;
  for (int first = 0; first + window <= clip.frame_count(); first += window) {
    Vec3 sum;
    for (int t = first; t < first + window; ++t) sum += clip.at(t, foot);
    means.push_back(sum / static_cast<float>(window));
  }
  return means;
}

}  // namespace

void FloorEvidence::AddFoot(const Clip& person, int joint) {
  struct Rests {
    Vec3 sum;
    int count = 0;
  };
  std::map<std::pair<double, double>, Rests> cells;
  const auto cell = [](float metres) {
    return std::floor(static_cast<double>(metres) / kPlaceMetres);
  };
  const std::vector<Vec3> means = MeanPositions(person, joint);
  for (std::size_t i = 0; i + 1 < means.size(); ++i) {
    // Negated, so that positions that are not finite do not rest.
    const auto distance = static_cast<double>(Distance(means[i], means[i + 1]));
    if (!(distance <= kRestSpeed * kRestSeconds)) continue;
    const Vec3 at = (means[i] + means[i + 1]) / 2;
    Rests& rests = cells[{cell(at.x), cell(at.z)}];
    rests.sum += at;
    ++rests.count;
  }
  if (cells.size() < 2) return;
  for (const auto& [key, rests] : cells) {
    const Vec3 mean = rests.sum / static_cast<float>(rests.count);
    places_.push_back({feet_, mean.x, mean.y, mean.z});
  }
  ++feet_;
}

void FloorEvidence::Add(const Skeleton& skeleton, const Clip& person) {
  AddFoot(person, skeleton.feet->left);
  AddFoot(person, skeleton.feet->right);
}

// The places relative to the weighted mean place of the same foot.
std::vector<FloorEvidence::Place> FloorEvidence::Centred(const std::vector<Place>& places) const {
  std::vector<Place> sums(feet_);
  for (Place& sum : sums) sum.weight = 0;
  for (const Place& place : places) {
    Place& sum = sums[place.foot];
    sum.x += place.weight * place.x;
    sum.y += place.weight * place.y;
    sum.z += place.weight * place.z;
    sum.weight += place.weight;
  }
  std::vector<Place> centred = places;
  for (Place& place : centred) {
    const Place& sum = sums[place.foot];
    place.x -= sum.x / sum.weight;
    place.y -= sum.y / sum.weight;
    place.z -= sum.z / sum.weight;
  }
  return centred;
}

Information FloorEvidence::NormalEquations(const std::vector<Place>& centred) {
  Information in = {kLeastSpread, 0, kLeastSpread, 0, 0};
  for (const Place& p : centred) {
    in += {p.weight * p.x * p.x, p.weight * p.x * p.z, p.weight * p.z * p.z, -p.weight * p.x * p.y,
           -p.weight * p.z * p.y};
  }
  return in;
}

// Scatter about the plane, with the expected scatter as if from kExpectedWeight more places.
double FloorEvidence::Scatter(const std::vector<double>& residuals,
                              const std::vector<Place>& centred) const {
  double squares = kExpectedWeight * kExpectedScatter * kExpectedScatter, weight = kExpectedWeight;
  for (std::size_t i = 0; i < centred.size(); ++i) {
    squares += centred[i].weight * residuals[i] * residuals[i];
    weight += centred[i].weight;
  }
  const double parameters = 2 + static_cast<double>(feet_);
  return std::sqrt(squares / std::max(1.0, weight - parameters));
}

std::optional<SlopeEstimate> FloorEvidence::Estimate() const {
  if (places_.empty()) return std::nullopt;
  std::vector<Place> places = places_;
  SlopeEstimate slope;
  double scatter = 0;
  for (int step = 0; step < kFitSteps; ++step) {
    const std::vector<Place> centred = Centred(places);
    slope = Solve(NormalEquations(centred));
    std::vector<double> residuals;
    for (const Place& p : centred) {
      residuals.push_back(std::abs(p.y + slope.mean.x * p.x + slope.mean.z * p.z));
    }
    scatter = Scatter(residuals, centred);
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i].weight = std::min(1.0, kReach * scatter / std::max(residuals[i], kLeastSpread));
    }
  }
  const double relative = scatter / kCleanScatter, least = kLeastError * relative * relative;
  slope.xx = slope.xx * scatter * scatter + least * least;
  slope.xz = slope.xz * scatter * scatter;
  slope.zz = slope.zz * scatter * scatter + least * least;
  return slope;
}

}  // namespace duet::motion
