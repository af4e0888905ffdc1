#ifndef DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_
#define DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/report/table.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

// The data of figures. scripts/make_report.py draws them.

namespace duet::evaluation::report {

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

using Plot = std::variant<LatentPlot, PosePlot>;

// The field "kind" names the alternative: "latent" or "poses". Values that are not finite
// are null. Positions are in metres, rounded to 0.1 mm.
nlohmann::ordered_json ToJson(const Plot& plot);

struct ResultFigure {
  std::string name;     // of its files, lower_snake_case, unique within the report
  std::string caption;  // one or two sentences
  Plot plot;
};

// The results of one duet-eval command, as the report prints them.
struct ResultSection {
  std::string id;                 // lower_snake_case; names the file and orders the report
  std::string title;              // a heading
  std::vector<std::string> text;  // paragraphs before the tables
  std::vector<Table> tables;
  std::vector<ResultFigure> figures;
  // What produced it, in order: data, folds, seeds, sizes, hashes of the judges.
  std::vector<std::pair<std::string, std::string>> settings;
  std::string command;  // reproduces the section; folders are placeholders
  std::string date;     // YYYY-MM-DD
};

// Writes <folder>/<id>.json, whole or not at all.
// Errors: INVALID_ARGUMENT naming the field for an id or a figure's name that is not 1 to 64 of
// a-z, 0-9 and _, a repeated name, an infinite value.
absl::Status WriteSection(const ResultSection& section, const std::filesystem::path& folder);

// Today, YYYY-MM-DD, in UTC.
std::string Today();

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_
