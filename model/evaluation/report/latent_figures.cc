#include "model/evaluation/report/latent_figures.h"

#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::evaluation::report {

Table LatentTable() {
  Table table;
  table.title = "Share of clips whose nearest neighbours are of their class";
  table.columns = {"1 in the map", "1 in the space",
                   absl::StrCat(experiments::kLatentNeighbours, " in the space")};
  table.decimals = 3;
  return table;
}

TableRow LatentRow(const std::string& name, const experiments::LatentMap& map) {
  return {name, {map.purity_of_map, map.nearest_neighbour, map.several_neighbours}};
}

ScatterPlot PlotByClass(std::string title, const std::vector<std::string>& class_names,
                        const std::vector<metrics::Point2>& points,
                        const std::vector<int>& classes) {
  ScatterPlot plot{std::move(title), {}};
  for (const std::string& name : class_names) plot.series.push_back({name, {}});
  for (size_t i = 0; i < points.size(); ++i) {
    plot.series[static_cast<size_t>(classes[i])].points.push_back(points[i]);
  }
  return plot;
}

}  // namespace duet::evaluation::report
