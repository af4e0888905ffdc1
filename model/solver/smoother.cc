#include "model/solver/smoother.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace duet::solver {
namespace {

// The weight of not correcting a given frame.
constexpr double kGiven = 1e9;

// A symmetric matrix of five diagonals: rows hold the diagonal and the two entries right of it.
using Bands = std::vector<std::array<double, 3>>;

// Adds weight * (sum_i terms[i] d[t + i])^2 to the cost.
void AddSquare(double weight, std::size_t t, const std::array<double, 3>& terms, std::size_t count,
               Bands* bands) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i; j < count; ++j) (*bands)[t + i][j - i] += weight * terms[i] * terms[j];
  }
}

// Factorises in place (L D L^T): the entries right of the diagonal become those of L.
void Factorise(Bands* bands) {
  const std::size_t n = bands->size();
  for (std::size_t t = 0; t < n; ++t) {
    const std::array<double, 3> row = (*bands)[t];
    for (std::size_t i = 1; i < 3 && t + i < n; ++i) {
      const double factor = row[i] / row[0];
      for (std::size_t j = i; j < 3 && t + j < n; ++j) {
        (*bands)[t + i][j - i] -= factor * row[j];
      }
      (*bands)[t][i] = factor;
    }
  }
}

// Solves for the right side `values`, in place.
void Solve(const Bands& factors, std::vector<double>* values) {
  const std::size_t n = factors.size();
  for (std::size_t t = 0; t < n; ++t) {
    for (std::size_t i = 1; i < 3 && t + i < n; ++i) {
      (*values)[t + i] -= factors[t][i] * (*values)[t];
    }
  }
  for (std::size_t t = n; t-- > 0;) {
    double rest = (*values)[t] / factors[t][0];
    for (std::size_t i = 1; i < 3 && t + i < n; ++i) rest -= factors[t][i] * (*values)[t + i];
    (*values)[t] = rest;
  }
}

// Nothing to correct: the correction is zero without solving for it.
bool AreZero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0; });
}

bool IsGiven(const CorrectionCost& cost, std::size_t frame) {
  return static_cast<int>(frame) < cost.given;
}

Bands FactorsOf(const CorrectionCost& cost, const std::vector<double>& weights) {
  const std::size_t n = weights.size();
  const double s = cost.seconds * cost.frame_rate_hz;
  Bands bands(n, {0, 0, 0});
  for (std::size_t t = 0; t < n; ++t) {
    bands[t][0] += IsGiven(cost, t) ? kGiven : weights[t] + cost.near;
    if (t + 1 < n) AddSquare(s * s, t, {-1, 1, 0}, 2, &bands);
    if (t + 2 < n) AddSquare(s * s * s * s / 4, t, {1, -2, 1}, 3, &bands);
  }
  Factorise(&bands);
  return bands;
}

}  // namespace

std::vector<double> SmoothCorrection(const CorrectionCost& cost, const std::vector<double>& weights,
                                     const std::vector<double>& wishes) {
  std::vector<double> values(wishes.size());
  for (std::size_t t = 0; t < values.size(); ++t) {
    values[t] = IsGiven(cost, t) ? 0 : weights[t] * wishes[t];
  }
  if (!AreZero(values)) Solve(FactorsOf(cost, weights), &values);
  return values;
}

std::vector<motion::Vec3> SmoothShift(const CorrectionCost& cost,
                                      const std::vector<double>& weights,
                                      const std::vector<motion::Vec3>& wishes) {
  Bands factors;
  std::vector<motion::Vec3> result(wishes.size());
  std::vector<double> values(wishes.size());
  for (float motion::Vec3::*const coordinate :
       {&motion::Vec3::x, &motion::Vec3::y, &motion::Vec3::z}) {
    for (std::size_t t = 0; t < values.size(); ++t) {
      values[t] = IsGiven(cost, t) ? 0 : weights[t] * double{wishes[t].*coordinate};
    }
    if (AreZero(values)) continue;
    if (factors.empty()) factors = FactorsOf(cost, weights);
    Solve(factors, &values);
    for (std::size_t t = 0; t < values.size(); ++t) {
      result[t].*coordinate = static_cast<float>(values[t]);
    }
  }
  return result;
}

}  // namespace duet::solver
