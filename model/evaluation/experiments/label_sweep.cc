#include "model/evaluation/experiments/label_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/evaluation/experiments/estimate.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::experiments {
namespace {

constexpr int kStepsAUnit = 4;
// Of SweepWeights: -1, 0 and 1.
constexpr size_t kMinusOne = 0, kZero = kStepsAUnit, kOne = 2 * kStepsAUnit;
// Changes of the probability up to this count as level: a probability of 0 cannot fall.
constexpr double kLevelChange = 1e-3;

const std::vector<std::string>& ControlColumns() {
  static const auto& columns = *new std::vector<std::string>{
      "0 to 1: up", "level", "0 to -1: down", "level", "a step up", "level", "rank correlation"};
  return columns;
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

// The raised class's probability at each weight.
std::vector<double> Raised(const SweepCurve& curve) {
  std::vector<double> raised;
  for (const auto& of_weight : curve.probabilities) {
    raised.push_back(double{of_weight[static_cast<size_t>(curve.raised)]});
  }
  return raised;
}

// Shapes: returns [ControlColumns].
std::vector<double> ControlOf(const SweepCurve& curve) {
  const std::vector<double> p = Raised(curve);
  const auto level = [](double by) { return std::abs(by) <= kLevelChange ? 1.0 : 0.0; };
  const auto up = [](double by) { return by > kLevelChange ? 1.0 : 0.0; };
  double steps_up = 0, steps_level = 0;
  for (size_t i = kZero; i < kOne; ++i) {
    steps_up += up(p[i + 1] - p[i]) / kStepsAUnit;
    steps_level += level(p[i + 1] - p[i]) / kStepsAUnit;
  }
  const double raised = p[kOne] - p[kZero], lowered = p[kZero] - p[kMinusOne];
  return {up(raised),
          level(raised),
          up(lowered),
          level(lowered),
          steps_up,
          steps_level,
          Correlation(Ranks(SweepWeights()), Ranks(p))};
}

// The means of columns; NaN without rows.
std::vector<double> Means(const std::vector<std::vector<double>>& rows, size_t columns) {
  return rows.empty() ? std::vector<double>(columns, NAN) : report::ColumnMeans(rows);
}

void AddKind(const std::vector<std::string>& classes, const std::vector<SweepCurve>& curves,
             bool own, const std::string& title, report::ResultSection* section) {
  report::Table control{title, ControlColumns()}, probabilities{title + ": probabilities"};
  for (const double weight : SweepWeights()) probabilities.columns.push_back(absl::StrCat(weight));
  std::vector<std::vector<double>> all;
  for (size_t c = 0; c < classes.size(); ++c) {
    std::vector<std::vector<double>> controls, raised;
    for (const SweepCurve& curve : curves) {
      if (curve.raised != static_cast<int>(c) || (curve.own == curve.raised) != own) continue;
      controls.push_back(ControlOf(curve));
      raised.push_back(Raised(curve));
    }
    control.rows.push_back({classes[c], Means(controls, ControlColumns().size())});
    probabilities.rows.push_back({classes[c], Means(raised, SweepWeights().size())});
    all.insert(all.end(), controls.begin(), controls.end());
  }
  control.rows.push_back({"all", Means(all, ControlColumns().size())});
  control.notes = {
      "Shares of answers whose probability of the class goes the way its weight goes. Level: by "
      "0.001 or less, either way. Steps: by 0.25, from weight 0 to 1. Rank correlation: "
      "Spearman's, of weight and probability from -1 to 2, the mean over answers."};
  probabilities.notes = {"The judges' mean probability of a class, by its weight."};
  section->tables.push_back(std::move(control));
  section->tables.push_back(std::move(probabilities));
}

}  // namespace

const std::vector<double>& SweepWeights() {
  static const auto& weights =
      *new std::vector<double>{-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2};
  return weights;
}

void AddSweep(const std::vector<std::string>& classes, const std::vector<SweepCurve>& curves,
              const std::string& told, report::ResultSection* section) {
  AddKind(classes, curves, true, absl::StrCat("Own class alone, ", told), section);
  AddKind(classes, curves, false, absl::StrCat("Another class beside the own one, ", told),
          section);
}

}  // namespace duet::evaluation::experiments
