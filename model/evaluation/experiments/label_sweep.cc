#include "model/evaluation/experiments/label_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>

#include "model/base/statistics.h"
#include "model/evaluation/experiments/synthesizer_method.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kLeastWeight = -1;
constexpr int kStepsAUnit = 4;
constexpr int kUnits = 3;
// Of SweepWeights: -1, 0 and 1.
constexpr size_t kMinusOne = 0, kZero = kStepsAUnit, kOne = 2 * kStepsAUnit;

double RaisedProbability(const SweepCurve& curve, size_t weight) {
  return curve.probabilities[weight][static_cast<size_t>(curve.raised)];
}

std::vector<double> RaisedProbabilities(const SweepCurve& curve) {
  std::vector<double> values;
  for (size_t i = 0; i < curve.probabilities.size(); ++i) {
    values.push_back(RaisedProbability(curve, i));
  }
  return values;
}

// Ranks from 1; ties share the mean of theirs.
std::vector<double> Ranks(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (size_t first = 0; first < order.size();) {
    size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (size_t i = first; i < end; ++i) {
      ranks[order[i]] = static_cast<double>(first + end + 1) / 2;
    }
    first = end;
  }
  return ranks;
}

// Adds a curve's figures to the sums, which MeasureControl divides by the number of curves.
void AddCurve(const SweepCurve& curve, LabelControl* sums) {
  const auto change = [&](size_t from, size_t to) {
    return RaisedProbability(curve, to) - RaisedProbability(curve, from);
  };
  const auto level = [](double by) { return std::abs(by) <= kLevelChange ? 1.0 : 0.0; };
  const auto up = [](double by) { return by > kLevelChange ? 1.0 : 0.0; };
  sums->raised_up += up(change(kZero, kOne));
  sums->raised_level += level(change(kZero, kOne));
  sums->lowered_down += up(change(kMinusOne, kZero));
  sums->lowered_level += level(change(kMinusOne, kZero));
  for (size_t i = kZero; i < kOne; ++i) {
    sums->steps_up += up(change(i, i + 1)) / kStepsAUnit;
    sums->steps_level += level(change(i, i + 1)) / kStepsAUnit;
  }
  sums->rank_correlation += RankCorrelation(SweepWeights(), RaisedProbabilities(curve));
}

}  // namespace

const std::vector<double>& SweepWeights() {
  static const auto& weights = *[] {
    auto* all = new std::vector<double>;
    for (int i = 0; i <= kUnits * kStepsAUnit; ++i) {
      all->push_back(kLeastWeight + static_cast<double>(i) / kStepsAUnit);
    }
    return all;
  }();
  return weights;
}

std::vector<float> SweepLabels(int classes, int own, int raised, double weight) {
  std::vector<float> labels = OneClass(classes, own);
  labels[static_cast<size_t>(raised)] = static_cast<float>(weight);
  return labels;
}

LabelControl MeasureControl(const std::vector<SweepCurve>& curves) {
  LabelControl control;
  for (const SweepCurve& curve : curves) AddCurve(curve, &control);
  const double count = curves.empty() ? std::numeric_limits<double>::quiet_NaN()
                                      : static_cast<double>(curves.size());
  for (double* value :
       {&control.raised_up, &control.raised_level, &control.lowered_down, &control.lowered_level,
        &control.steps_up, &control.steps_level, &control.rank_correlation}) {
    *value /= count;
  }
  return control;
}

double RankCorrelation(const std::vector<double>& x, const std::vector<double>& y) {
  const std::vector<double> a = Ranks(x), b = Ranks(y);
  const double mean_a = base::Mean(a), mean_b = base::Mean(b);
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa * bb == 0 ? 0 : ab / std::sqrt(aa * bb);
}

std::vector<SweepCurve> Select(const std::vector<SweepCurve>& curves, SweepKind kind, int raised) {
  std::vector<SweepCurve> selected;
  for (const SweepCurve& curve : curves) {
    const bool own = curve.own == curve.raised;
    if (curve.raised == raised && own == (kind == SweepKind::kOwn)) selected.push_back(curve);
  }
  return selected;
}

std::vector<SweepCurve> SelectOwn(const std::vector<SweepCurve>& curves, int own) {
  std::vector<SweepCurve> selected;
  std::copy_if(curves.begin(), curves.end(), std::back_inserter(selected),
               [&](const SweepCurve& curve) { return curve.own == own; });
  return selected;
}

std::vector<double> MeanProbabilities(const std::vector<SweepCurve>& curves, int of_class) {
  std::vector<double> means;
  for (size_t i = 0; i < SweepWeights().size(); ++i) {
    double sum = 0;
    for (const SweepCurve& curve : curves) {
      sum += curve.probabilities[i][static_cast<size_t>(of_class)];
    }
    means.push_back(sum / static_cast<double>(curves.size()));
  }
  return means;
}

}  // namespace duet::evaluation::experiments
