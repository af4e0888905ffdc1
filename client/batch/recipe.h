#ifndef DUET_CLIENT_BATCH_RECIPE_H_
#define DUET_CLIENT_BATCH_RECIPE_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/request.h"
#include "duet/batch/v1/batch.pb.h"
#include "model/formats/motion_file.h"
#include "model/motion/vec3.h"

namespace duet::client::batch {

namespace v1 = ::duet::batch::v1;

using Labels = std::vector<ClassWeight>;  // by class name

struct LeaderInput {
  v1::Side side = v1::SIDE_LEFT;
  bool starts_as_other_person = false;
  formats::ReadOptions reading;    // without side and skeleton
  std::optional<motion::Vec3> up;  // the vertical of every leader (SynthesisOptions::up)
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
  v1::Output output;
  // Digest of everything above in hex. Recipes with the same digest are equal.
  std::string digest;
  // The same as one JSON object with the proto's field names.
  std::string json;
};

// Parses a recipe: JSON or text format. Unknown fields are rejected. INVALID_ARGUMENT "FIELD:
// expected ..., got ...".
absl::StatusOr<Recipe> ParseRecipe(absl::string_view text, bool json);

// Reads a recipe file: JSON if it ends in ".json", otherwise text format. Errors name the file;
// also NOT_FOUND.
absl::StatusOr<Recipe> ReadRecipe(const std::filesystem::path& path);

// One JSON object with the proto's field names.
std::string ToJson(const google::protobuf::Message& message, bool add_whitespace = false);

// How a recipe was changed, both as Recipe::json: "modified: seed: 7 -> 9; added:
// output.formats[1]: FORMAT_GLB". Empty if they are equal, or if one of them is no recipe.
std::string DescribeDifference(const std::string& before, const std::string& now);

// A label vector of a recipe, by class name.
Labels ToLabels(const v1::Labels& proto);

struct WeightRange {
  float min = 1;
  float max = 1;
};
// What mixes say, with their defaults.
WeightRange RangeOf(const v1::Mixes& mixes);
uint32_t ClassesInMix(const v1::Mixes& mixes);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_H_
