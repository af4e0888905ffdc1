#include "model/evaluation/report/metric_tables.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::evaluation::report {
namespace {

std::vector<MetricStyle> Styles() {
  constexpr Best kLow = Best::kLowest, kHigh = Best::kHighest, kNone = Best::kNone;
  return {
      {"afd", "Average frame distance (Eq. 6), SBU's raw unit", 3, kLow, false, false},
      {"afd_squared", "Average squared frame distance, raw unit squared", 3, kLow, false, false},
      {"afd_m", "Average frame distance, metres", 3, kLow, false, false},
      {"afd_squared_m", "Average squared frame distance, m^2", 3, kLow, false, false},
      {"root_aligned_afd", "Average frame distance about the own root, SBU's raw unit", 3, kLow,
       false, false},
      {"root_aligned_afd_m", "Average frame distance about the own root, metres", 3, kLow, false,
       false},
      {"velocity_error", "Velocity error, m/s", 3, kLow, false, false},
      {"bone_length_drift", "Drift of bone lengths, share of the length", 4, kNone, false, true},
      {"jitter", "Jitter, m/s^3", 1, kNone, false, true},
      {"skating_ratio", "Steps on the floor faster than 0.5 m/s, share", 3, kNone, false, true},
      {"foot_slide_cm", "Feet on the floor slide, centimetres a frame", 2, kNone, false, true},
      {"penetration_frequency", "Frames in which the bodies touch or overlap, share", 3, kNone,
       false, true},
      {"penetration_depth_m", "Depth of overlap in those frames, metres", 3, kNone, false, true},
      {"joint_speed", "Mean speed of the joints without noise, m/s", 3, kNone, false, true},
      {"range_of_motion_m", "Range of motion without noise, metres", 3, kNone, false, true},
      {"filtered_jerk", "Jitter without noise, m/s^3", 1, kNone, false, true},
      {"lean_degrees", "Lean from hips to neck, degrees", 1, kNone, false, true},
      {"facing_degrees", "Turned away from the leader, degrees", 1, kNone, false, true},
      {"root_distance_m", "Distance to the leader, metres", 3, kNone, false, true},
      {"touch", "Frames in which a hand or foot touches the leader, share", 3, kNone, false, true},
      {kAccuracy, "Accuracy of the fold's judge", 3, kHigh, true, true},
      {kFrechet, "Frechet distance to captured followers, features of the fold's judge", 2, kLow,
       true, false},
      {kDiversity, "Diversity: mean distance between motions of a class, the judge's features", 2,
       kNone, true, true},
  };
}

void AddNotes(const MetricStyle& style, Table* table) {
  if (style.name == kFrechet || style.name == kDiversity) {
    table->notes.push_back(
        "Per fold and class, averaged over the folds with two motions of the class or more. Each "
        "fold's judge has learnt from captured followers of the fold's training people alone.");
  } else if (style.name == kAccuracy) {
    table->notes.push_back(
        "The share of test motions that the fold's judge, trained on captured followers of the "
        "fold's training people alone, takes for the class asked for.");
  } else if (style.of_captured) {
    table->notes.push_back("Captured motion is not perfect: compare with its row, not with zero.");
  }
}

}  // namespace

const std::vector<MetricStyle>& MetricStyles() {
  static const auto& styles = *new std::vector<MetricStyle>(Styles());
  return styles;
}

Table MetricTable(const MetricStyle& style, const std::vector<std::string>& classes,
                  const std::vector<MethodFigures>& methods) {
  Table table;
  table.title = absl::StrCat(style.title, " (", style.name, ")");
  table.columns = classes;
  table.decimals = style.decimals;
  table.best = style.best;
  for (const MethodFigures& method : methods) {
    const auto figures = method.by_metric.find(style.name);
    if (figures == method.by_metric.end() || (method.captured && !style.of_captured)) continue;
    table.rows.push_back({method.name, figures->second, /*printed=*/false});
  }
  AddMeanColumn(&table);
  AddNotes(style, &table);
  return table;
}

void AddPrintedRows(const Table& paper, Table* table) {
  Table printed = paper;
  AddMeanColumn(&printed);
  if (printed.columns != table->columns) {
    table->notes.push_back("The paper prints no figures for these classes.");
    return;
  }
  for (TableRow& row : printed.rows) {
    row.name = absl::StrCat("paper: ", row.name);
    table->rows.push_back(std::move(row));
  }
  table->notes.insert(table->notes.end(), printed.notes.begin(), printed.notes.end());
}

}  // namespace duet::evaluation::report
