#ifndef DUET_CLIENT_BATCH_RECIPE_CONVERSION_H_
#define DUET_CLIENT_BATCH_RECIPE_CONVERSION_H_

#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "duet/batch/v1/batch.pb.h"

namespace duet::client::batch {

namespace v1 = ::duet::batch::v1;

// Checks every field and sets absent fields to their defaults. The digest stays empty.
// INVALID_ARGUMENT "reactions[2].grid.axes[0].weights: expected ..., got ...".
absl::StatusOr<Recipe> FromProto(const v1::Recipe& proto);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_RECIPE_CONVERSION_H_
