#ifndef DUET_CLIENT_BATCH_RECIPE_H_
#define DUET_CLIENT_BATCH_RECIPE_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/request.h"
#include "duet/batch/v1/batch.pb.h"
#include "model/classifier/classifier.h"
#include "model/formats/motion_file.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

namespace v1 = ::duet::batch::v1;

using Labels = std::vector<ClassWeight>;  // by class name

// Label vectors at times: 0 is the leader's first frame, 1 its last.
struct TimedLabels {
  double at = 0;
  Labels labels;
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
  formats::ReadOptions reading;  // without side and skeleton
  Level level;
  // The vertical of every leader, for requests: of `level`, or what an automatic one found.
  std::optional<motion::Vec3> up;
};

// A recipe that was checked. proto/duet/batch/v1/batch.proto documents the fields.
struct Recipe {
  uint64_t seed = 0;
  std::vector<ModelChoice> models;  // at least one
  google::protobuf::RepeatedPtrField<v1::Reaction> reactions;
  int samples = 1;
  float variety = 1;
  int candidates = 1;
  LeaderInput input;
  v1::QualityFilter filter;
  std::shared_ptr<const classifier::Classifier> classifier;  // of the filter; null: none
  v1::Output output;                                         // with a layout
  // Digest of everything above in hex. Recipes with the same digest are equal.
  std::string digest;
  // The same as one JSON object with the proto's field names. Files that the recipe names
  // are represented by their content.
  std::string json;
};

// Values of the command line that override the recipe.
struct RecipeOverrides {
  std::optional<int> retries_per_item;
  std::string input_format;  // empty: the recipe's
  std::optional<double> frame_rate_hz;
  std::string level;  // empty: the recipe's
};

// Parses a recipe: JSON or text format. Unknown fields are rejected. Files that it names
// are relative to `folder`. INVALID_ARGUMENT "FIELD: expected ..., got ...".
absl::StatusOr<Recipe> ParseRecipe(absl::string_view text, bool json,
                                   const std::filesystem::path& folder = {},
                                   const RecipeOverrides& overrides = {});

// Reads a recipe file: JSON if it ends in ".json", otherwise text format. Errors name the file;
// also NOT_FOUND.
absl::StatusOr<Recipe> ReadRecipe(const std::filesystem::path& path,
                                  const RecipeOverrides& overrides = {});

// How two recipes differ, each as Recipe::json: 'seed: expected 7, got 9; output.formats[1]:
// expected none, got "FORMAT_CSV"', the first five fields and the number of the others. Empty if
// they are equal, or if one of them is not a JSON object.
std::string DescribeDifference(const std::string& expected, const std::string& got);

// A label vector of a recipe, by class name.
Labels ToLabels(const v1::Labels& proto);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_H_
