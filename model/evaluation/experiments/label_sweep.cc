#include "model/evaluation/experiments/label_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "absl/strings/str_cat.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/experiments/estimate.h"

namespace duet::evaluation::experiments {
namespace {

constexpr int kStepsAUnit = 4;
// Of SweepWeights: -1, 0 and 1.
constexpr size_t kMinusOne = 0, kZero = kStepsAUnit, kOne = 2 * kStepsAUnit;

// The columns of the table.
struct Column {
  const char* name;
  double LabelControl::*figure;
};
constexpr Column kColumns[] = {{"0 to 1: up", &LabelControl::raised_up},
                               {"level", &LabelControl::raised_level},
                               {"0 to -1: down", &LabelControl::lowered_down},
                               {"level", &LabelControl::lowered_level},
                               {"a step up", &LabelControl::steps_up},
                               {"level", &LabelControl::steps_level},
                               {"rank correlation", &LabelControl::rank_correlation}};

double RaisedProbability(const SweepCurve& curve, size_t weight) {
  return curve.probabilities[weight][static_cast<size_t>(curve.raised)];
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
  std::vector<double> raised;
  for (size_t i = 0; i < curve.probabilities.size(); ++i) {
    raised.push_back(RaisedProbability(curve, i));
  }
  sums->rank_correlation += RankCorrelation(SweepWeights(), raised);
}

}  // namespace

const std::vector<double>& SweepWeights() {
  static const auto& weights =
      *new std::vector<double>{-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2};
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
  const double count = curves.empty() ? NAN : static_cast<double>(curves.size());
  for (const Column& column : kColumns) control.*column.figure /= count;
  return control;
}

double RankCorrelation(const std::vector<double>& x, const std::vector<double>& y) {
  return Correlation(Ranks(x), Ranks(y));
}

std::vector<SweepCurve> Select(const std::vector<SweepCurve>& curves, SweepKind kind, int raised) {
  std::vector<SweepCurve> selected;
  for (const SweepCurve& curve : curves) {
    const bool own = curve.own == curve.raised;
    if (curve.raised == raised && own == (kind == SweepKind::kOwn)) selected.push_back(curve);
  }
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

report::Table ControlTable(const std::string& title, const std::vector<std::string>& classes,
                           const std::vector<SweepCurve>& curves, SweepKind kind) {
  report::Table table{title};
  for (const Column& column : kColumns) table.columns.push_back(column.name);
  const auto add = [&table](const std::string& name, const std::vector<SweepCurve>& measured) {
    const LabelControl control = MeasureControl(measured);
    report::TableRow& row = table.rows.emplace_back(report::TableRow{name, {}});
    for (const Column& column : kColumns) row.values.push_back(control.*column.figure);
  };
  std::vector<SweepCurve> all;
  for (size_t c = 0; c < classes.size(); ++c) {
    const std::vector<SweepCurve> selected = Select(curves, kind, static_cast<int>(c));
    add(classes[c], selected);
    all.insert(all.end(), selected.begin(), selected.end());
  }
  add("all", all);
  table.notes = {
      "Shares of answers whose probability of the class goes the way its weight goes. Level: by "
      "0.001 or less, either way. Steps: by 0.25, from weight 0 to 1. Rank correlation: "
      "Spearman's, of weight and probability from -1 to 2, the mean over answers."};
  return table;
}

report::Table ProbabilityTable(const std::string& title, const std::vector<std::string>& classes,
                               const std::vector<SweepCurve>& curves, SweepKind kind) {
  report::Table table{title};
  for (const double weight : SweepWeights()) table.columns.push_back(absl::StrCat(weight));
  for (size_t c = 0; c < classes.size(); ++c) {
    const int raised = static_cast<int>(c);
    table.rows.push_back({classes[c], MeanProbabilities(Select(curves, kind, raised), raised)});
  }
  table.notes = {"The judges' mean probability of a class, by its weight."};
  return table;
}

void AddSweep(const std::vector<std::string>& classes, const std::vector<SweepCurve>& curves,
              const std::string& told, report::ResultSection* section) {
  for (const SweepKind kind : {SweepKind::kOwn, SweepKind::kAdded}) {
    const std::string title = absl::StrCat(kind == SweepKind::kOwn ? "Own class alone, "
                                                                   : "Another class beside the own "
                                                                     "one, ",
                                           told);
    section->tables.push_back(ControlTable(title, classes, curves, kind));
    section->tables.push_back(
        ProbabilityTable(absl::StrCat(title, ": probabilities"), classes, curves, kind));
  }
}

}  // namespace duet::evaluation::experiments
