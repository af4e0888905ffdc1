#ifndef DUET_MODEL_TRAINING_NAMED_CONFIGS_H_
#define DUET_MODEL_TRAINING_NAMED_CONFIGS_H_

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/training/options.h"

namespace duet::training {

// A configuration of model/training/configs, linked into the program.
struct NamedConfig {
  std::string_view name;
  std::string_view json;
};

const std::vector<NamedConfig>& NamedConfigs();

// The configuration of this name, or null.
const NamedConfig* FindConfig(std::string_view name);

// Parses a configuration in either form: all settings (ParseTrainingOptions), or the differences
// from a named one: {"base": "default", "set": {"losses.bone": 0}}. `replacements` are applied
// last. Errors: INVALID_ARGUMENT naming the field.
absl::StatusOr<TrainingOptions> ParseConfig(
    std::string_view json,
    const std::vector<std::pair<std::string, std::string>>& replacements = {});

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_NAMED_CONFIGS_H_
