#include "model/evaluation/report/validation_table.h"

#include <algorithm>
#include <limits>

namespace duet::evaluation::report {
namespace {

constexpr int kDecimals = 4;

// Every run's name, in the order of first appearance.
std::vector<std::string> Names(const std::vector<ValidatedRuns>& configurations) {
  std::vector<std::string> names;
  for (const ValidatedRuns& configuration : configurations) {
    for (const LoggedRun& run : configuration.runs) {
      if (std::find(names.begin(), names.end(), run.name) == names.end()) names.push_back(run.name);
    }
  }
  return names;
}

double Last(const ValidatedRuns& configuration, const std::string& name,
            const std::string& column) {
  for (const LoggedRun& run : configuration.runs) {
    const std::vector<double>* values = run.name == name ? run.log.Find(column) : nullptr;
    if (values != nullptr) return values->back();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Table ValidationTable(const std::string& title, const std::string& column,
                      const std::vector<ValidatedRuns>& configurations) {
  Table table;
  table.title = title;
  table.decimals = kDecimals;
  table.best = Best::kLowest;
  table.columns = Names(configurations);
  for (const ValidatedRuns& configuration : configurations) {
    TableRow row = {configuration.name, {}};
    for (const std::string& name : table.columns) {
      row.values.push_back(Last(configuration, name, column));
    }
    table.rows.push_back(std::move(row));
  }
  AddMeanColumn(&table);
  return table;
}

}  // namespace duet::evaluation::report
