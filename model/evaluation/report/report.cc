#include "model/evaluation/report/report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "model/base/file.h"
#include "model/base/statistics.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::ordered_json;

std::string Rounded(double value, int decimals) {
  return std::isnan(value) ? "-" : absl::StrFormat("%.*f", decimals, value);
}

constexpr const char* kBestNames[] = {"none", "lowest", "highest"};  // as in Best

// NaN becomes null.
ordered_json ToJson(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back({{"name", row.name}, {"printed", row.printed}, {"values", row.values}});
  }
  return {{"title", table.title},       {"columns", table.columns},
          {"rows", std::move(rows)},    {"notes", table.notes},
          {"decimals", table.decimals}, {"best", kBestNames[static_cast<size_t>(table.best)]}};
}

ordered_json ToJson(const Section& section) {
  ordered_json tables = ordered_json::array(), figures = tables, settings = tables;
  for (const Table& table : section.tables) tables.push_back(ToJson(table));
  for (const Figure& figure : section.figures) {
    figures.push_back({{"name", figure.name}, {"caption", figure.caption}, {"plot", figure.plot}});
  }
  for (const auto& [name, value] : section.settings) {
    settings.push_back({{"name", name}, {"value", value}});
  }
  return {{"format_version", 1},
          {"id", section.id},
          {"title", section.title},
          {"text", section.text},
          {"tables", std::move(tables)},
          {"figures", std::move(figures)},
          {"settings", std::move(settings)},
          {"command", section.command},
          {"date", absl::FormatTime("%Y-%m-%d", absl::Now(), absl::UTCTimeZone())}};
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

// Columns of the summary: a figure and its heading.
struct Column {
  const char* figure;
  const char* heading;
  bool ratio = false;  // to the captured followers' figure, class by class
};
constexpr Column kSummary[] = {{"joint_speed", "speed ratio", true},
                               {"range_of_motion_m", "range ratio", true},
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

// The mean over the classes; NaN if there is no such figure.
double MeanFigure(const Column& column, const MethodFigures& method,
                  const MethodFigures& captured) {
  const auto found = method.by_metric.find(column.figure);
  if (found == method.by_metric.end()) return NAN;
  std::vector<double> of_classes = found->second;
  if (column.ratio) {
    const std::vector<double>& real = captured.by_metric.at(column.figure);
    for (size_t c = 0; c < of_classes.size(); ++c) of_classes[c] /= real[c];
  }
  return base::Mean(of_classes);
}

// A table of figures that the paper prints for SBU.
Table Printed(const char* title, std::vector<TableRow> rows, const char* note) {
  for (TableRow& row : rows) row.printed = true;
  return {title,
          {"kick", "push", "shake_hands", "hug", "exchange_object", "punch"},
          std::move(rows),
          {note}};
}

}  // namespace

std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows) {
  return OverColumns(rows, base::Mean);
}

void AddMeanColumn(Table* table) {
  table->columns.push_back("mean");
  for (TableRow& row : table->rows) row.values.push_back(base::Summarise(row.values).mean);
}

std::string ToPlainText(const Table& table) {
  std::vector<std::vector<std::string>> lines = {{""}};
  lines[0].insert(lines[0].end(), table.columns.begin(), table.columns.end());
  for (const TableRow& row : table.rows) {
    lines.push_back({row.name});
    for (const double value : row.values) lines.back().push_back(Rounded(value, table.decimals));
  }
  std::vector<size_t> widths(lines[0].size());
  for (const std::vector<std::string>& line : lines) {
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text = table.title + '\n';
  for (const std::vector<std::string>& line : lines) {
    text += absl::StrFormat("%-*s", static_cast<int>(widths[0]), line[0]);
    for (size_t i = 1; i < line.size(); ++i) {
      text += absl::StrFormat("  %*s", static_cast<int>(widths[i]), line[i]);
    }
    text += '\n';
  }
  for (const std::string& note : table.notes) text += "  " + note + '\n';
  return text;
}

absl::Status WriteSection(const Section& section, const std::filesystem::path& folder) {
  std::error_code error;  // base::WriteFile reports a folder that cannot be made
  std::filesystem::create_directories(folder, error);
  const std::string text =
      ToJson(section).dump(1, ' ', false, ordered_json::error_handler_t::replace);
  return base::WriteFile(folder / (section.id + ".json"), text + '\n');
}

const std::vector<MetricStyle>& MetricStyles() {
  constexpr Best kLow = Best::kLowest, kHigh = Best::kHighest, kNone = Best::kNone;
  static const auto& styles = *new std::vector<MetricStyle>{
      {"afd", "Average frame distance (Eq. 6), SBU's raw unit", 3, kLow},
      {"afd_squared", "Average squared frame distance, raw unit squared", 3, kLow},
      {"afd_m", "Average frame distance, metres", 3, kLow},
      {"root_aligned_afd", "Average frame distance about the own root, SBU's raw unit", 3, kLow},
      {"velocity_error", "Velocity error, m/s", 3, kLow},
      {"bone_length_drift", "Drift of bone lengths, share of the length", 4, kNone, true},
      {"jitter", "Jitter, m/s^3", 1, kNone, true},
      {"skating_ratio", "Steps on the floor faster than 0.5 m/s, share", 3, kNone, true},
      {"foot_slide_cm", "Feet on the floor slide, centimetres a frame", 2, kNone, true},
      {"penetration_frequency", "Frames in which the bodies touch or overlap, share", 3, kNone,
       true},
      {"penetration_depth_m", "Depth of overlap in those frames, metres", 3, kNone, true},
      {"joint_speed", "Mean speed of the joints without noise, m/s", 3, kNone, true},
      {"range_of_motion_m", "Range of motion without noise, metres", 3, kNone, true},
      {"lean_degrees", "Lean from hips to neck, degrees", 1, kNone, true},
      {"facing_degrees", "Turned away from the leader, degrees", 1, kNone, true},
      {"root_distance_m", "Distance to the leader, metres", 3, kNone, true},
      {"touch", "Frames in which a hand or foot touches the leader, share", 3, kNone, true},
      {kAccuracy, "Accuracy of the fold's judge", 3, kHigh, true, true},
      {kFrechet, "Frechet distance to captured followers, features of the fold's judge", 2, kLow,
       false, true},
      {kDiversity, "Diversity: mean distance between motions of a class, the judge's features", 2,
       kNone, true, true},
  };
  return styles;
}

Table MetricTable(const MetricStyle& style, const std::vector<std::string>& classes,
                  const std::vector<MethodFigures>& methods) {
  Table table{absl::StrCat(style.title, " (", style.name, ")"),
              classes,
              {},
              {},
              style.decimals,
              style.best};
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

Table SampleSummary(const std::vector<MethodFigures>& methods) {
  Table table{"All figures, means over the classes"};
  table.decimals = 3;
  for (const Column& column : kSummary) table.columns.push_back(column.heading);
  for (const MethodFigures& method : methods) {
    TableRow row = {method.name, {}};
    for (const Column& column : kSummary) {
      row.values.push_back(MeanFigure(column, method, methods.front()));
    }
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

Table PaperAfdSbu() {
  return Printed(
      "Average frame distance on SBU, as printed (Tables 1 and 4)",
      {{"NN", {.81, .51, .48, .61, .63, .56}},
       {"HMM", {.92, .60, 1.41, .67, 3.84, .66}},
       {"KZBH12", {.65, .45, .42, .48, .53, .48}},
       {"HK14", {.92, .61, .54, .81, .74, .66}},
       {"HFKB15", {.67, .48, .42, .47, .54, .52}},
       {"MSHL22", {.53, .52, .44, .72, .45, .45}},
       {"Goel et al. 2022", {.50, .43, .40, .42, .40, .32}},
       {"w/o D", {.53, .45, .42, .49, .44, .38}},
       {"w/o L_b", {.45, .42, .39, .40, .39, .32}},
       {"w/o L_c", {.59, .45, .55, .46, .41, .40}},
       {"w/o FC", {.55, .47, .46, .49, .41, .40}},
       {"w/o multi-hot embedding", {.51, .48, .50, .66, .46, .45}}},
      "Printed for seven subjects, six of whom are measured here. The formula printed (Eq. 6) is "
      "the mean norm; the released code averages the squared norm and keeps the epoch that does "
      "best on the test set. The figures lie between the two readings, so both are measured: afd "
      "and afd_squared. The unit is SBU's raw one.");
}

Table PaperFidSbu() {
  return Printed("Frechet distance on SBU, as printed (Table 2)",
                 {{"MSHL22", {10.8, 20.8, 23.8, 29.5, 16.7, 11.2}},
                  {"Goel et al. 2022", {9.3, 16.8, 15.1, 19.3, 11.7, 10.8}}},
                 "The feature extractor is not known: only ratios between rows under one "
                 "extractor can be compared.");
}

Table PaperAugmentation() {
  return Printed("Accuracy of a classifier on SBU, as printed (Table 6)",
                 {{"original", {.947, .941, .692, .538, .667, .889}},
                  {"augmented", {.996, .877, .706, .641, .881, .911}}},
                 "Half of the data trains, half tests; 25 + 25 synthetic sequences are added. The "
                 "split and the number of runs are not printed.");
}

}  // namespace duet::evaluation::report
