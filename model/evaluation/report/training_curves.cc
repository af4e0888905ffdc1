#include "model/evaluation/report/training_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/evaluation/report/plot.h"

namespace duet::evaluation::report {
namespace {

struct Loss {
  const char* column;
  const char* label;
};
constexpr Loss kLosses[] = {
    {"generator", "generator, weighted sum"},
    {"reconstruction", "reconstruction"},
    {"bone", "bone lengths"},
    {"continuity", "continuity"},
    {"adversarial", "adversarial"},
    {"discriminator", "discriminator"},
};
constexpr char kSmoothing[] = "Strong lines are means over nine epochs, faint ones the epochs.";
constexpr char kValidation[] = "validation_afd";
constexpr int kRunningMean = 9;  // epochs
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Null unless the loss was on.
const std::vector<double>* FindLoss(const experiments::TrainingLog& log,
                                    const std::string& column) {
  const std::vector<double>* values = log.Find(column);
  if (values == nullptr) return nullptr;
  const bool is_on =
      std::any_of(values->begin(), values->end(), [](double v) { return std::abs(v) > 0; });
  return is_on ? values : nullptr;
}

PlotSeries Line(const std::string& name, const experiments::TrainingLog& log,
                const std::vector<double>& values) {
  PlotSeries line = {name, {}};
  for (size_t i = 0; i < values.size(); ++i) {
    // Epochs that were not measured are no gap: validation is not run in each.
    if (!std::isnan(values[i])) line.points.push_back({log.epochs[i], values[i]});
  }
  return line;
}

// The index of the least figure.
size_t Least(const std::vector<double>& values) {
  size_t least = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    // A comparison with a missing figure is false.
    if (std::isnan(values[least]) || values[i] < values[least]) least = i;
  }
  return least;
}

void AddFigure(const std::string& name, std::string caption, const LinePlot& plot,
               ResultSection* section) {
  if (plot.series.empty()) return;
  section->figures.push_back(
      {absl::StrCat(section->id, "_", name), std::move(caption), ToSvg(plot)});
}

void DrawLossesOf(const LoggedRun& run, ResultSection* section) {
  LinePlot plot;
  plot.title = absl::StrCat("Losses of ", run.name);
  plot.x_label = "epoch";
  plot.y_label = "mean loss of an epoch (logarithmic)";
  plot.log_y = true;
  plot.running_mean = kRunningMean;
  for (const Loss& loss : kLosses) {
    const std::vector<double>* values = FindLoss(run.log, loss.column);
    if (values != nullptr) plot.series.push_back(Line(loss.label, run.log, *values));
  }
  AddFigure("losses", absl::StrCat("Every loss of the run by epoch. ", kSmoothing), plot, section);
}

void DrawAcrossRuns(const std::vector<LoggedRun>& runs, const Loss& loss, ResultSection* section) {
  LinePlot plot;
  plot.title = absl::StrCat("Loss: ", loss.label);
  plot.x_label = "epoch";
  plot.y_label = "mean loss of an epoch (logarithmic)";
  plot.log_y = true;
  plot.running_mean = kRunningMean;
  for (const LoggedRun& run : runs) {
    const std::vector<double>* values = FindLoss(run.log, loss.column);
    if (values != nullptr) plot.series.push_back(Line(run.name, run.log, *values));
  }
  AddFigure(loss.column,
            absl::StrCat("Loss by epoch: ", loss.label, "; one line a run. ", kSmoothing), plot,
            section);
}

void DrawValidation(const std::vector<LoggedRun>& runs, ResultSection* section) {
  LinePlot plot;
  plot.title = "Average frame distance on the validation clips";
  plot.x_label = "epoch";
  plot.y_label = "average frame distance";
  for (const LoggedRun& run : runs) {
    const std::vector<double>* values = run.log.Find(kValidation);
    if (values == nullptr) continue;
    plot.series.push_back(Line(run.name, run.log, *values));
    if (runs.size() == 1) plot.marked_x = {run.log.epochs[Least(*values)]};
  }
  AddFigure(kValidation,
            absl::StrCat("Average frame distance on clips that the run held back, by epoch",
                         runs.size() == 1 ? "; the dotted line marks the least." : "."),
            plot, section);
}

double Sum(const std::vector<double>* values) {
  if (values == nullptr) return kMissing;
  double sum = 0;
  for (const double value : *values) sum += std::isnan(value) ? 0 : value;
  return sum;
}

Table LengthTable(const std::vector<LoggedRun>& runs) {
  Table table;
  table.title = "What the runs took";
  table.columns = {"epochs", "seconds", "epoch of the least validation error"};
  table.decimals = 0;
  for (const LoggedRun& run : runs) {
    const std::vector<double>* validation = run.log.Find(kValidation);
    table.rows.push_back({run.name,
                          {run.log.epochs.back(), Sum(run.log.Find("seconds")),
                           validation == nullptr ? kMissing : run.log.epochs[Least(*validation)]}});
  }
  return table;
}

Table ReachedTable(const std::vector<LoggedRun>& runs) {
  Table table;
  table.title = "What the runs reached";
  table.columns = {"reconstruction, last epoch", "bone lengths, last epoch",
                   "validation error, least"};
  table.decimals = 4;
  for (const LoggedRun& run : runs) {
    const auto last = [&](const char* column) {
      const std::vector<double>* values = run.log.Find(column);
      return values == nullptr ? kMissing : values->back();
    };
    const std::vector<double>* validation = run.log.Find(kValidation);
    table.rows.push_back({run.name,
                          {last("reconstruction"), last("bone"),
                           validation == nullptr ? kMissing : (*validation)[Least(*validation)]}});
  }
  return table;
}

}  // namespace

ResultSection DrawTrainingCurves(const std::vector<LoggedRun>& runs, const std::string& id) {
  ResultSection section;
  section.id = id;
  section.tables = {LengthTable(runs), ReachedTable(runs)};
  if (runs.size() == 1) {
    DrawLossesOf(runs[0], &section);
  } else {
    for (const Loss& loss : kLosses) DrawAcrossRuns(runs, loss, &section);
  }
  DrawValidation(runs, &section);
  return section;
}

}  // namespace duet::evaluation::report
