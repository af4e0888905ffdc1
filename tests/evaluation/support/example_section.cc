#include "tests/evaluation/support/example_section.h"

#include <cmath>

namespace duet::test {

evaluation::report::ResultSection ExampleSection(const std::string& id) {
  evaluation::report::Table table;
  table.title = "Errors <raw> & all";
  table.columns = {"kick", "shake_hands"};
  table.rows = {{"ours", {0.504, 1.0 / 3}, false},
                {"paper", {0.1, 0.2}, true},
                {"frozen_first_frame", {0.7, std::nan("")}, false}};
  table.notes = {"lower is better"};
  table.decimals = 3;
  table.best = evaluation::report::Best::kLowest;
  evaluation::report::ResultSection section;
  section.id = id;
  section.title = "Methods & classes";
  section.text = {"First <paragraph>.", "Second one."};
  section.tables = {table};
  evaluation::report::LatentPlot plot;
  plot.title = "Curve";
  plot.class_names = {"kick"};
  plot.classes = {0};
  plot.features = {{1, 2}};
  section.figures = {{id + "_curve", "A curve of \"errors\".", plot}};
  section.settings = {{"data", "SBU"}, {"seeds", "1, 2"}};
  section.command = "duet-eval folds --data DIR";
  section.date = "2024-02-29";
  return section;
}

}  // namespace duet::test
