#ifndef DUET_CLIENT_BATCH_SET_DESCRIPTION_H_
#define DUET_CLIENT_BATCH_SET_DESCRIPTION_H_

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "client/batch/split.h"
#include "client/result.h"

namespace duet::client::batch {

// What dataset.json states about a model beyond its name and skeleton.
struct DescribedModel {
  std::string weights_sha256;
  std::string terms;
  std::optional<bool> free_for_all_uses;  // absent in sets begun by a version that did not ask
  std::string description;
  std::vector<std::string> interaction_classes;
  double frame_rate_hz = 0;
  bool samples = false;
};

// What dataset.json states about a set before it has any item. It is settled when the set is begun
// and kept in job.json, so that a merge, which asks no server, states the same.
struct SetDescription {
  std::vector<DescribedModel> models;  // as JobIdentity::models; empty: not known
  std::vector<Format> formats;
  std::optional<double> frame_rate_hz;  // of every item
  Splits splits;
};

// The classes of all models, each once, in the order of the models.
std::vector<std::string> AllClasses(const SetDescription& description);

// "FORMAT_NPY": its name in proto/duet/batch/v1/batch.proto.
std::string FormatName(Format format);

DescribedModel Describe(const ModelInfo& model);

nlohmann::ordered_json ToJson(const SetDescription& description);
// INVALID_ARGUMENT naming the field. `json` may come from anywhere.
absl::StatusOr<SetDescription> SetDescriptionFromJson(const nlohmann::json& json);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SET_DESCRIPTION_H_
