#ifndef DUET_CLIENT_BATCH_RECIPE_FILE_H_
#define DUET_CLIENT_BATCH_RECIPE_FILE_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

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

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_FILE_H_
