#ifndef DUET_CLIENT_BATCH_RECIPE_H_
#define DUET_CLIENT_BATCH_RECIPE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "client/request.h"
#include "model/classifier/classifier.h"
#include "model/formats/motion_file.h"
#include "model/motion/coordinates.h"

namespace duet::client::batch {

// A recipe. proto/duet/batch/v1/batch.proto documents the fields.

using Labels = std::vector<ClassWeight>;  // by class name

struct Grid {
  struct Axis {
    std::string interaction_class;
    std::vector<float> weights;
  };
  std::vector<Axis> axes;
};

struct WeightRange {
  float min = 1;
  float max = 1;
};

struct Mixes {
  int count = 0;
  std::vector<std::string> classes;  // empty: every class of the first model
  int classes_in_mix = 2;
  WeightRange weight = {0.25f, 1};
};

struct EachClass {
  std::vector<std::string> classes;  // as of Mixes
  WeightRange weight;
  std::optional<WeightRange> beside;  // of another class
};

struct Schedule {
  struct Keyframe {
    double at = 0;  // 0 the leader's first frame, 1 its last
    Labels labels;
  };
  std::vector<Keyframe> keyframes;
};

struct Reaction {
  std::string name;  // may be empty
  std::variant<Labels, Grid, Mixes, EachClass, Schedule> kind;
};

enum class Sides { kLeft, kRight, kBoth };

// How to level leaders from a tilted camera.
struct Level {
  bool automatic = true;           // estimate the vertical; level if the evidence is strong
  std::optional<motion::Vec3> up;  // the vertical, if the caller specifies it
};

struct LeaderInput {
  std::optional<Sides> side;  // absent: as index.tsv states, or left
  bool starts_as_other_person = false;
  std::optional<double> frame_rate_hz;
  std::optional<double> metres_per_unit;
  std::optional<motion::LengthUnit> unit;
  std::optional<motion::UpAxis> up_axis;
  retargeting::JointOverrides joint_map;
  std::optional<formats::Format> format;
  Level level;
  // The vertical of every leader, for requests: of `level`, or what an automatic one found.
  std::optional<motion::Vec3> up;
};

struct QualityFilter {
  std::optional<double> max_lean_degrees;
  std::optional<double> max_foot_above_floor_metres;
  std::optional<double> max_foot_below_floor_metres;
  std::optional<double> min_distance_metres;
  std::optional<double> max_distance_metres;
  std::optional<double> max_penetration_metres;
  std::optional<double> min_range_of_motion_metres;
  std::optional<double> max_unfamiliarity;
  std::optional<double> max_twisted;
  std::optional<double> max_overlapping;
  std::optional<double> max_skating_over_leader;
  std::shared_ptr<const classifier::Classifier> classifier;  // null: no classifier
  std::optional<double> min_class_probability;
  int retries_per_item = 0;
};

enum class Format { kBvh, kCsv, kNpy, kJson, kGlb };
enum class Layout { kMirror, kClassFolders, kSbu, kK3hi };

struct Output {
  std::vector<Format> formats;  // none where the layout has its own
  Layout layout = Layout::kMirror;
  std::optional<double> frame_rate_hz;  // of every item; absent: the rate of its leader
};

struct Recipe {
  uint64_t seed = 0;
  std::vector<ModelChoice> models;  // at least one
  std::vector<Reaction> reactions;
  int samples = 1;
  float variety = 1;
  int candidates = 1;
  LeaderInput input;
  QualityFilter filter;
  Output output;
  // Digest of everything above in hex. Recipes with the same digest are equal.
  std::string digest;
  // The same as one JSON object with the proto's field names. Files that the recipe names
  // are represented by their content.
  std::string json;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_H_
