#include "model/evaluation/report/sample_tables.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "model/base/statistics.h"

namespace duet::evaluation::report {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr char kSpeedRatio[] = "speed_ratio", kRangeRatio[] = "range_ratio";
constexpr char kSpeed[] = "joint_speed", kRange[] = "range_of_motion_m";

// Columns of the summary: a figure and its heading.
struct Column {
  const char* figure;
  const char* heading;
};
constexpr Column kSummary[] = {{kSpeedRatio, "speed ratio"},
                               {kRangeRatio, "range ratio"},
                               {kAccuracy, "accuracy"},
                               {kPooledFrechet, "FID"},
                               {kFilteredFrechet, "FID, filt."},
                               {kDiversity, "diversity"},
                               {kFilteredDiversity, "div., filt."},
                               {kMultimodality, "MM"},
                               {"afd", "afd one"},
                               {kMeanAnswerAfd, "afd mean"},
                               {kBestAnswerAfd, "afd best"},
                               {"lean_degrees", "lean"},
                               {"facing_degrees", "facing"},
                               {"touch", "touch"},
                               {"foot_slide_cm", "slide"},
                               {"penetration_frequency", "pen. freq."},
                               {"penetration_depth_m", "pen. depth"}};

std::vector<MetricStyle> Styles() {
  constexpr Best kLow = Best::kLowest, kNoBest = Best::kNone;
  std::vector<MetricStyle> styles = {
      {kSpeedRatio, "Mean speed of the joints, ratio to captured, both without noise", 2, kNoBest,
       false, true},
      {kRangeRatio, "Range of motion, ratio to captured, both without noise", 2, kNoBest, false,
       true},
      {kMeanAnswerAfd, "Average frame distance of the mean answer, SBU's raw unit", 3, kLow},
      {kMeanAnswerAfdMetres, "Average frame distance of the mean answer, metres", 3, kLow},
      {kBestAnswerAfd, "Average frame distance of the best answer, SBU's raw unit", 3, kLow},
      {kBestAnswerAfdMetres, "Average frame distance of the best answer, metres", 3, kLow},
      {kMultimodality, "Multimodality: mean distance between answers to one leader, raw unit", 3,
       kNoBest},
      {kFilteredDiversity, "Diversity without noise, the judge's features", 2, kNoBest, true,
       true}};
  for (const MetricStyle& style : MetricStyles()) styles.push_back(style);
  return styles;
}

double Figure(const MethodFigures& method, const std::string& name) {
  const auto found = method.by_metric.find(name);
  return found == method.by_metric.end() ? kNone : base::Mean(found->second);
}

void AddRatio(const std::string& figure, const std::string& ratio, const MethodFigures& captured,
              MethodFigures* method) {
  const auto made = method->by_metric.find(figure);
  const auto real = captured.by_metric.find(figure);
  if (made == method->by_metric.end() || real == captured.by_metric.end()) return;
  std::vector<double> ratios;
  for (size_t c = 0; c < made->second.size(); ++c) {
    ratios.push_back(made->second[c] / real->second[c]);
  }
  method->by_metric[ratio] = std::move(ratios);
}

std::vector<MethodFigures> WithRatios(std::vector<MethodFigures> methods) {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [](const MethodFigures& method) { return method.captured; });
  if (found == methods.end()) return methods;
  const MethodFigures captured = *found;
  for (MethodFigures& method : methods) {
    AddRatio(kSpeed, kSpeedRatio, captured, &method);
    AddRatio(kRange, kRangeRatio, captured, &method);
  }
  return methods;
}

// Groups of rows of one name, in order of first appearance.
std::vector<std::vector<MethodFigures>> ByName(const std::vector<MethodFigures>& rows) {
  std::vector<std::vector<MethodFigures>> groups;
  for (const MethodFigures& row : rows) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& other) {
      return other.front().name == row.name;
    });
    if (group == groups.end()) {
      groups.push_back({row});
    } else {
      group->push_back(row);
    }
  }
  return groups;
}

MethodFigures MeanOfRows(const std::vector<MethodFigures>& rows) {
  MethodFigures mean = rows.front();
  for (auto& [name, values] : mean.by_metric) {
    for (size_t c = 0; c < values.size(); ++c) {
      std::vector<double> of_rows;
      for (const MethodFigures& row : rows) of_rows.push_back(row.by_metric.at(name)[c]);
      values[c] = base::Mean(of_rows);
    }
  }
  return mean;
}

Table EmptySummary(const std::string& title) {
  Table table;
  table.title = title;
  table.decimals = 3;
  for (const Column& column : kSummary) table.columns.push_back(column.heading);
  return table;
}

}  // namespace

std::vector<MethodFigures> MeanByName(const std::vector<MethodFigures>& rows) {
  std::vector<MethodFigures> means;
  for (const std::vector<MethodFigures>& group : ByName(rows)) means.push_back(MeanOfRows(group));
  return means;
}

Table SampleSummary(const std::vector<MethodFigures>& methods) {
  Table table = EmptySummary("All figures, means over the classes");
  for (const MethodFigures& method : MeanByName(WithRatios(methods))) {
    TableRow row = {method.name, {}};
    for (const Column& column : kSummary) row.values.push_back(Figure(method, column.figure));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "Speed and range: ratios to captured followers, both under a Gaussian of 0.1 s, of class "
      "means. FID: of all classes together within a fold; filt.: both sides under the same "
      "Gaussian. MM: mean afd between two answers to one leader. afd, SBU's raw unit: of one "
      "answer, of the mean of all answers, of the best of all. Lean, facing: degrees. Slide: "
      "centimetres a frame. Depth: metres."};
  return table;
}

Table SampleSpread(const std::vector<MethodFigures>& methods) {
  Table table = EmptySummary("Spread over training seeds, standard deviation");
  for (const std::vector<MethodFigures>& group : ByName(WithRatios(methods))) {
    if (group.size() < 2) continue;
    TableRow row = {group.front().name, {}};
    for (const Column& column : kSummary) {
      std::vector<double> values;
      for (const MethodFigures& method : group) values.push_back(Figure(method, column.figure));
      row.values.push_back(base::Summarise(values).deviation);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<Table> SampleTables(const std::vector<std::string>& classes,
                                const std::vector<MethodFigures>& methods) {
  const std::vector<MethodFigures> rows = MeanByName(WithRatios(methods));
  std::vector<Table> tables;
  for (const MetricStyle& style : Styles()) {
    tables.push_back(MetricTable(style, classes, rows));
    if (tables.back().rows.empty()) tables.pop_back();
  }
  return tables;
}

}  // namespace duet::evaluation::report
