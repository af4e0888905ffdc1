#include "model/evaluation/report/trial_tables.h"

namespace duet::evaluation::report {
namespace {

constexpr int kDecimals = 3;

Table EmptyTable(const std::string& title, const experiments::Trials& trials) {
  Table table;
  table.title = title;
  table.columns = trials.columns();
  table.decimals = kDecimals;
  return table;
}

}  // namespace

Table MeansTable(const std::string& title, const experiments::Trials& trials) {
  Table table = EmptyTable(title, trials);
  table.best = Best::kHighest;
  for (const experiments::TrialSummary& summary : trials.Summaries()) {
    table.rows.push_back({summary.row, summary.means});
  }
  return table;
}

Table DeviationsTable(const std::string& title, const experiments::Trials& trials) {
  Table table = EmptyTable(title, trials);
  for (const experiments::TrialSummary& summary : trials.Summaries()) {
    table.rows.push_back({summary.row, summary.deviations});
  }
  return table;
}

Table GainsTable(const std::string& title, const experiments::Trials& trials,
                 const std::string& base) {
  Table table = EmptyTable(title, trials);
  for (const experiments::TrialSummary& gain : trials.Gains(base)) {
    table.rows.push_back({gain.row, gain.means});
    table.rows.push_back({gain.row + ", deviation", gain.deviations});
    table.rows.push_back({gain.row + ", share above 0", gain.above_zero});
  }
  return table;
}

}  // namespace duet::evaluation::report
