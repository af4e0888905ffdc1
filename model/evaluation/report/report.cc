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
    rows.push_back({{"name", row.name}, {"values", row.values}});
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

template <typename Figure>
std::vector<double> OverColumns(const std::vector<std::vector<double>>& rows, Figure figure) {
  std::vector<double> figures;
  for (size_t c = 0; !rows.empty() && c < rows.front().size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row[c]);
    figures.push_back(figure(values));
  }
  return figures;
}

}  // namespace

std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows) {
  return OverColumns(rows, base::Mean);
}

std::vector<double> ColumnDeviations(const std::vector<std::vector<double>>& rows) {
  return OverColumns(rows, [](const auto& values) { return base::Summarise(values).deviation; });
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
  const std::string beside = "Captured motion is not perfect: compare with its row, not with zero.";
  const std::string within =
      "Per fold and class, averaged over the folds with two motions of the class or more. Each "
      "fold's judge has learnt from captured followers of the fold's training people alone.";
  constexpr Best kLow = Best::kLowest, kHigh = Best::kHighest, kNone = Best::kNone;
  static const auto& styles = *new std::vector<MetricStyle>{
      {"afd", "Average frame distance (Eq. 6), SBU's raw unit", 3, kLow},
      {"afd_squared", "Average squared frame distance, raw unit squared", 3, kLow},
      {"afd_m", "Average frame distance, metres", 3, kLow},
      {"root_aligned_afd", "Average frame distance about the own root, SBU's raw unit", 3, kLow},
      {"velocity_error", "Velocity error, m/s", 3, kLow},
      {"bone_length_drift", "Drift of bone lengths, share of the length", 4, kNone, beside},
      {"jitter", "Jitter, m/s^3", 1, kNone, beside},
      {"skating_ratio", "Steps on the floor faster than 0.5 m/s, share", 3, kNone, beside},
      {"foot_slide_cm", "Feet on the floor slide, centimetres a frame", 2, kNone, beside},
      {"penetration_frequency", "Frames in which the bodies touch or overlap, share", 3, kNone,
       beside},
      {"penetration_depth_m", "Depth of overlap in those frames, metres", 3, kNone, beside},
      {"joint_speed", "Mean speed of the joints without noise, m/s", 3, kNone, beside},
      {"range_of_motion_m", "Range of motion without noise, metres", 3, kNone, beside},
      {"lean_degrees", "Lean from hips to neck, degrees", 1, kNone, beside},
      {"facing_degrees", "Turned away from the leader, degrees", 1, kNone, beside},
      {"root_distance_m", "Distance to the leader, metres", 3, kNone, beside},
      {"touch", "Frames in which a hand or foot touches the leader, share", 3, kNone, beside},
      {kAccuracy, "Accuracy of the fold's judge", 3, kHigh,
       "The share of test motions that the fold's judge, trained on captured followers of the "
       "fold's training people alone, takes for the class asked for.",
       true},
      {kFrechet, "Frechet distance to captured followers, features of the fold's judge", 2, kLow,
       within, true},
      {kDiversity, "Diversity: mean distance between motions of a class, the judge's features", 2,
       kNone, within, true},
  };
  return styles;
}

Table MetricTable(const MetricStyle& style, const std::vector<std::string>& classes,
                  const std::vector<MethodFigures>& methods) {
  Table table{absl::StrCat(style.title, " (", style.name, ")"), classes};
  table.decimals = style.decimals;
  table.best = style.best;
  for (const MethodFigures& method : methods) {
    const auto figures = method.by_metric.find(style.name);
    const bool of_captured = method.name == kCaptured;
    if (figures == method.by_metric.end() || (of_captured && style.best == Best::kLowest)) continue;
    std::vector<double>& values =
        table.rows.emplace_back(TableRow{method.name, figures->second}).values;
    values.push_back(base::Summarise(values).mean);
  }
  table.columns.push_back("mean");
  if (!style.note.empty()) table.notes = {style.note};
  return table;
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

}  // namespace duet::evaluation::report
