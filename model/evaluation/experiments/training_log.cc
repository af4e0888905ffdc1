#include "model/evaluation/experiments/training_log.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"

namespace duet::evaluation::experiments {
namespace {

constexpr char kEpoch[] = "epoch";

// Reads "nan" and "-nan" too, which a run that diverged may have written.
bool ParseFigure(absl::string_view field, double* value) {
  *value = std::numeric_limits<double>::quiet_NaN();
  return field.empty() || field == "nan" || field == "-nan" || base::ParseNumber(field, value);
}

absl::Status CheckNames(const std::vector<std::string>& names, absl::string_view source) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) return base::ErrorAt(source, 1, "a column without a name");
    if (!seen.insert(name).second) {
      return base::ErrorAt(source, 1,
                           absl::StrCat("the column ", base::Quoted(name), " is repeated"));
    }
  }
  if (seen.count(kEpoch) != 0) return absl::OkStatus();
  return base::ErrorAt(source, 1,
                       absl::StrCat("columns ", base::Quoted(names[0]), "..., wanted `epoch` too"));
}

absl::Status AddRow(const std::vector<std::string>& names, absl::string_view line,
                    absl::string_view source, int number, TrainingLog* log) {
  const std::vector<absl::string_view> fields = absl::StrSplit(line, ',');
  if (fields.size() != names.size()) {
    return base::ErrorAt(source, number,
                         absl::StrCat(fields.size(), " fields came, wanted ", names.size()));
  }
  for (size_t i = 0; i < fields.size(); ++i) {
    double value = 0;
    if (!ParseFigure(fields[i], &value)) {
      return base::ErrorAt(
          source, number,
          absl::StrCat(names[i], ": came ", base::Quoted(fields[i]), ", wanted a number"));
    }
    log->columns[names[i]].push_back(value);
  }
  const double epoch = log->columns[kEpoch].back();
  if (std::isnan(epoch) || (!log->epochs.empty() && epoch <= log->epochs.back())) {
    return base::ErrorAt(source, number,
                         absl::StrCat("epoch: came ", epoch, ", wanted a later one"));
  }
  log->epochs.push_back(epoch);
  return absl::OkStatus();
}

}  // namespace

const std::vector<double>* TrainingLog::Find(const std::string& column) const {
  const auto found = columns.find(column);
  if (found == columns.end()) return nullptr;
  const bool any = std::any_of(found->second.begin(), found->second.end(),
                               [](double value) { return std::isfinite(value); });
  return any ? &found->second : nullptr;
}

absl::StatusOr<TrainingLog> ParseTrainingLog(absl::string_view text, absl::string_view source) {
  base::LineReader lines(text);
  absl::string_view line;
  if (!lines.Next(&line)) return base::ErrorAt(source, 1, "empty, wanted a line of column names");
  const std::vector<std::string> names = absl::StrSplit(line, ',');
  if (absl::Status status = CheckNames(names, source); !status.ok()) return status;
  TrainingLog log;
  while (lines.Next(&line)) {
    absl::Status status = AddRow(names, line, source, lines.number(), &log);
    if (!status.ok()) return status;
  }
  if (log.epochs.empty()) return base::ErrorAt(source, 2, "no epoch, wanted one line for each");
  return log;
}

}  // namespace duet::evaluation::experiments
