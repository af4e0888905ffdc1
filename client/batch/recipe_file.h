#ifndef DUET_CLIENT_BATCH_RECIPE_FILE_H_
#define DUET_CLIENT_BATCH_RECIPE_FILE_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

// What the command line may say in place of the recipe.
struct RecipeOverrides {
  std::optional<Packing> packing;
  std::optional<int> retries_per_item;
  std::string input_format;  // empty: the recipe's
  std::optional<double> frame_rate_hz;
};

// Parses a recipe: JSON or text format. Unknown fields are refused. `folder` is where the files
// that it names lie. INVALID_ARGUMENT says where, what came and what was wanted.
absl::StatusOr<Recipe> ParseRecipe(absl::string_view text, bool json,
                                   const std::filesystem::path& folder = {},
                                   const RecipeOverrides& overrides = {});

// The same of a file; ".json" is JSON, anything else text format. Also NOT_FOUND; names the file.
absl::StatusOr<Recipe> ReadRecipe(const std::filesystem::path& path,
                                  const RecipeOverrides& overrides = {});

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_FILE_H_
