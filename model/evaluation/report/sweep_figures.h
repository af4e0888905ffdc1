#ifndef DUET_MODEL_EVALUATION_REPORT_SWEEP_FIGURES_H_
#define DUET_MODEL_EVALUATION_REPORT_SWEEP_FIGURES_H_

#include <string>
#include <vector>

#include "model/evaluation/experiments/label_sweep.h"
#include "model/evaluation/report/plot.h"
#include "model/evaluation/report/result_section.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// One row per raised class and one for all of them.
Table ControlTable(const std::string& title, const std::vector<std::string>& classes,
                   const std::vector<experiments::SweepCurve>& curves, experiments::SweepKind kind);

// kOwn: the mean probability of every class against the weight of class `raised`. kAdded: only that
// of class `raised`, a line for each own class.
LinePlot SweepPlot(const std::string& title, const std::vector<std::string>& classes,
                   const std::vector<experiments::SweepCurve>& curves, experiments::SweepKind kind,
                   int raised);

// The names of a sweep, by the model's input about the follower's first frame.
struct SweepNames {
  std::string told;      // ends titles and captions: "without a start"
  std::string name_end;  // ends the figures' names: "", "_root"
};

// Adds a sweep's tables, one per kind, and its figures, one per kind and raised class.
void AddSweep(const std::vector<std::string>& classes,
              const std::vector<experiments::SweepCurve>& curves, const SweepNames& names,
              ResultSection* section);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_SWEEP_FIGURES_H_
