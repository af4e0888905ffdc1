#include "model/solver/smoother.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace duet::solver {
namespace {

// A symmetric matrix of five diagonals: rows hold the diagonal and the two entries right of it.
using Bands = std::vector<std::array<double, 3>>;

// Adds weight * (sum_i terms[i] d[t + i])^2 to the cost.
void AddSquare(double weight, std::size_t t, const std::array<double, 3>& terms, std::size_t count,
               Bands* bands) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i; j < count; ++j) (*bands)[t + i][j - i] += weight * terms[i] * terms[j];
  }
}

// Solves by Cholesky's factorisation (L D L^T), in place.
void Solve(Bands* bands, std::vector<double>* values) {
  const std::size_t n = bands->size();
  for (std::size_t t = 0; t < n; ++t) {
    const std::array<double, 3> row = (*bands)[t];
    for (std::size_t i = 1; i < 3 && t + i < n; ++i) {
      const double factor = row[i] / row[0];
      for (std::size_t j = i; j < 3 && t + j < n; ++j) {
        (*bands)[t + i][j - i] -= factor * row[j];
      }
      (*values)[t + i] -= factor * (*values)[t];
    }
  }
  for (std::size_t t = n; t-- > 0;) {
    double rest = (*values)[t];
    for (std::size_t i = 1; i < 3 && t + i < n; ++i) rest -= (*bands)[t][i] * (*values)[t + i];
    (*values)[t] = rest / (*bands)[t][0];
  }
}

}  // namespace

std::vector<double> SmoothCorrection(const CorrectionCost& cost, const std::vector<double>& weights,
                                     const std::vector<double>& wishes) {
  const std::size_t n = wishes.size();
  const double s = cost.seconds * cost.frame_rate_hz;
  Bands bands(n, {0, 0, 0});
  std::vector<double> values(n);
  for (std::size_t t = 0; t < n; ++t) {
    bands[t][0] += weights[t] + cost.near;
    values[t] = weights[t] * wishes[t];
    if (t + 1 < n) AddSquare(s * s, t, {-1, 1, 0}, 2, &bands);
    if (t + 2 < n) AddSquare(s * s * s * s / 4, t, {1, -2, 1}, 3, &bands);
  }
  Solve(&bands, &values);
  return values;
}

}  // namespace duet::solver
