#ifndef DUET_MODEL_EVALUATION_REPORT_PLOT_H_
#define DUET_MODEL_EVALUATION_REPORT_PLOT_H_

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "model/evaluation/metrics/features.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

// The data of figures. scripts/make_report.py draws them.

namespace duet::evaluation::report {

struct PlotSeries {
  std::string name;
  std::vector<std::array<double, 2>> points;  // x, y; a point that is not finite leaves a gap
};

// Lines over labelled axes.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  std::optional<std::pair<double, double>> y_range;  // default: the range of the points
  bool log_y = false;                                // values of 0 and below leave gaps
  bool markers = false;                              // for sweeps with few points
  std::vector<double> marked_x;                      // vertical dotted lines
  // Above 1: lines are means over this many points, with the points themselves faint behind.
  int running_mean = 1;
};

// A map of a feature space by t-SNE, one point per sample. Shapes: features and classes [samples].
struct LatentPlot {
  std::string title;
  std::vector<std::string> class_names;
  std::vector<int> classes;
  metrics::FeatureSet features;
  double perplexity = 30;  // effective number of neighbours; lowered for few samples
  uint64_t seed = 1;       // of the map's start
};

// Two people under one name. Shapes: the same number of frames in both, at least 1, and in every
// pair of a plot.
struct PicturedPair {
  std::string name;
  motion::Poses leader;
  motion::Poses follower;
};

// Leader and follower as stick figures: a strip of moments, and an animation.
struct PosePlot {
  std::string title;
  motion::Skeleton skeleton;
  std::vector<PicturedPair> pairs;
  double frame_rate_hz = 0;
};

using Plot = std::variant<LinePlot, LatentPlot, PosePlot>;

// The field "kind" names the alternative: "lines", "latent" or "poses". Values that are not finite
// are null. Positions are in metres, rounded to 0.1 mm.
nlohmann::ordered_json ToJson(const Plot& plot);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_PLOT_H_
