#include "model/evaluation/report/long_tables.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::evaluation::report {
namespace {

using experiments::LongClipFigures;
using experiments::LongClipRow;

// Rows of one name, in order of first appearance.
using Groups = std::vector<std::pair<std::string, std::vector<LongClipRow>>>;

Groups GroupBy(const std::vector<LongClipRow>& rows,
               const std::function<std::string(const LongClipRow&)>& name_of) {
  Groups groups;
  for (const LongClipRow& row : rows) {
    const std::string name = name_of(row);
    size_t at = 0;
    while (at < groups.size() && groups[at].first != name) ++at;
    if (at == groups.size()) groups.push_back({name, {}});
    groups[at].second.push_back(row);
  }
  return groups;
}

std::string LeaderName(const LongClipRow& row) { return absl::StrCat(row.model, ": ", row.leader); }

Table LeanTable(const std::string& what, const std::vector<std::string>& classes,
                const std::vector<LongClipRow>& rows) {
  Table table;
  table.title = absl::StrCat("Largest lean, degrees, ", what);
  table.columns = classes;
  table.decimals = 1;
  for (const auto& [name, group] : GroupBy(rows, LeaderName)) {
    TableRow row = {name,
                    std::vector<double>(classes.size(), std::numeric_limits<double>::quiet_NaN())};
    for (const LongClipRow& clip : group) {
      double& worst = row.values[static_cast<size_t>(clip.interaction_class)];
      worst = std::fmax(worst, std::fmax(clip.figures.trunk_lean, clip.figures.body_lean));
    }
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "The larger one of hips to neck and feet to neck against the vertical, each the largest mean "
      "over one second."};
  return table;
}

Table WorstTable(const std::string& title, const Groups& groups) {
  Table table;
  table.title = title;
  table.columns = {"trunk lean", "body lean", "feet above",  "feet below", "farthest",
                   "last lean",  "last feet", "first speed", "last speed"};
  for (const auto& [name, rows] : groups) {
    const LongClipFigures w = Worst(rows);
    table.rows.push_back({name,
                          {w.trunk_lean, w.body_lean, w.feet_above, w.feet_below, w.farthest,
                           w.last_lean, w.last_feet, w.first_speed, w.last_speed},
                          false});
  }
  table.notes = {
      "Leans: degrees. Feet: how far the lower foot gets from the leader's floor, metres. "
      "Farthest: "
      "distance to the leader, metres. Over the last ten seconds: the larger lean's mean, and the "
      "lower foot's mean distance from the floor. Speeds of the joints over the first and the last "
      "ten seconds, without noise, m/s."};
  return table;
}

}  // namespace

std::vector<Table> LongTables(const std::string& what, const std::vector<std::string>& classes,
                              const std::vector<LongClipRow>& rows) {
  const auto class_name = [&](const LongClipRow& row) {
    return absl::StrCat(row.model, ": ", classes[static_cast<size_t>(row.interaction_class)]);
  };
  return {
      LeanTable(what, classes, rows),
      WorstTable(absl::StrCat("Worst class of each leader, ", what), GroupBy(rows, LeaderName)),
      WorstTable(absl::StrCat("Worst leader of each class, ", what), GroupBy(rows, class_name))};
}

}  // namespace duet::evaluation::report
