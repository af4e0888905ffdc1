#ifndef DUET_CLIENT_BATCH_RECIPE_FILE_H_
#define DUET_CLIENT_BATCH_RECIPE_FILE_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

// Values of the command line that override the recipe.
struct RecipeOverrides {
  std::optional<Packing> packing;
  std::optional<int> retries_per_item;
  std::string input_format;  // empty: the recipe's
  std::optional<double> frame_rate_hz;
  std::string level;                 // empty: the recipe's
  std::string layout;                // the same
  std::string body_model;            // the same; relative to the working directory
  std::optional<double> validation;  // Splits
  std::optional<double> test;
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

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_FILE_H_
