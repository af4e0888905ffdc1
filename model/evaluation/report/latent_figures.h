#ifndef DUET_MODEL_EVALUATION_REPORT_LATENT_FIGURES_H_
#define DUET_MODEL_EVALUATION_REPORT_LATENT_FIGURES_H_

#include <string>
#include <vector>

#include "model/evaluation/experiments/latent_map.h"
#include "model/evaluation/report/plot.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// The table of how well classes keep together, still without rows, and a map's row of it.
Table LatentTable();
TableRow LatentRow(const std::string& name, const experiments::LatentMap& map);

// The points of a map by class; a class without points keeps its colour and its place in the
// legend. Shapes: points and classes [samples].
ScatterPlot PlotByClass(std::string title, const std::vector<std::string>& class_names,
                        const std::vector<metrics::Point2>& points,
                        const std::vector<int>& classes);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_LATENT_FIGURES_H_
