#include "model/evaluation/report/sweep_figures.h"

#include <cstddef>

#include "absl/strings/str_cat.h"

namespace duet::evaluation::report {
namespace {

using experiments::SweepCurve;
using experiments::SweepKind;

std::vector<double> Values(const experiments::LabelControl& control) {
  return {control.raised_up, control.raised_level, control.lowered_down,    control.lowered_level,
          control.steps_up,  control.steps_level,  control.rank_correlation};
}

PlotSeries MeanLine(const std::string& name, const std::vector<SweepCurve>& curves, int of_class) {
  const std::vector<double>& weights = experiments::SweepWeights();
  const std::vector<double> means = MeanProbabilities(curves, of_class);
  PlotSeries line{name, {}};
  for (size_t i = 0; i < weights.size(); ++i) line.points.push_back({weights[i], means[i]});
  return line;
}

std::string KindTitle(SweepKind kind) {
  return kind == SweepKind::kOwn ? "Own class alone" : "Another class beside the own one";
}

// The title of the figure that sweeps the weight of class `name`.
std::string FigureTitle(SweepKind kind, const std::string& name, const std::string& told) {
  return absl::StrCat(name, kind == SweepKind::kOwn ? " alone, " : " added, ", told);
}

std::string Caption(SweepKind kind, const std::string& name, const std::string& told) {
  if (kind == SweepKind::kOwn) {
    return absl::StrCat("Leaders of ", name, " answered with the weight of ", name, " alone, ",
                        told, ": the judges' mean probability of every class.");
  }
  return absl::StrCat("Leaders of the other classes answered with their own class at 1 and ", name,
                      " added, ", told, ": the judges' mean probability of ", name, ".");
}

}  // namespace

Table ControlTable(const std::string& title, const std::vector<std::string>& classes,
                   const std::vector<SweepCurve>& curves, SweepKind kind) {
  Table table;
  table.title = title;
  table.columns = {"0 to 1: up", "level", "0 to -1: down",   "level",
                   "a step up",  "level", "rank correlation"};
  std::vector<SweepCurve> all;
  for (size_t c = 0; c < classes.size(); ++c) {
    const std::vector<SweepCurve> selected = Select(curves, kind, static_cast<int>(c));
    table.rows.push_back({classes[c], Values(MeasureControl(selected)), false});
    all.insert(all.end(), selected.begin(), selected.end());
  }
  table.rows.push_back({"all", Values(MeasureControl(all)), false});
  table.notes = {
      "Shares of answers whose probability of the class goes the way its weight goes. Level: by "
      "0.001 or less, either way. Steps: by 0.25, from weight 0 to 1. Rank correlation: "
      "Spearman's, of weight and probability from -1 to 2, the mean over answers."};
  return table;
}

LinePlot SweepPlot(const std::string& title, const std::vector<std::string>& classes,
                   const std::vector<SweepCurve>& curves, SweepKind kind, int raised) {
  const std::string& raised_name = classes[static_cast<size_t>(raised)];
  LinePlot plot;
  plot.title = title;
  plot.x_label = "weight of " + raised_name;
  plot.y_label =
      "mean probability of " + (kind == SweepKind::kOwn ? std::string("each class") : raised_name);
  plot.y_range = {0, 1};
  plot.markers = true;
  plot.marked_x = {0, 1};
  const std::vector<SweepCurve> selected = Select(curves, kind, raised);
  for (int c = 0; c < static_cast<int>(classes.size()); ++c) {
    const std::string& name = classes[static_cast<size_t>(c)];
    if (kind == SweepKind::kOwn) {
      if (!selected.empty()) plot.series.push_back(MeanLine(name, selected, c));
    } else {
      const std::vector<SweepCurve> beside = SelectOwn(selected, c);
      if (!beside.empty()) plot.series.push_back(MeanLine("beside " + name, beside, raised));
    }
  }
  return plot;
}

void AddSweep(const std::vector<std::string>& classes, const std::vector<SweepCurve>& curves,
              const SweepNames& names, ResultSection* section) {
  for (const SweepKind kind : {SweepKind::kOwn, SweepKind::kAdded}) {
    section->tables.push_back(
        ControlTable(absl::StrCat(KindTitle(kind), ", ", names.told), classes, curves, kind));
    const char* const kind_name = kind == SweepKind::kOwn ? "_own_" : "_added_";
    for (size_t c = 0; c < classes.size(); ++c) {
      const LinePlot plot = SweepPlot(FigureTitle(kind, classes[c], names.told), classes, curves,
                                      kind, static_cast<int>(c));
      section->figures.push_back({absl::StrCat(section->id, kind_name, classes[c], names.name_end),
                                  Caption(kind, classes[c], names.told), plot});
    }
  }
}

}  // namespace duet::evaluation::report
