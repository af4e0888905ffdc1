#ifndef DUET_MODEL_TRAINING_NAMED_CONFIGS_H_
#define DUET_MODEL_TRAINING_NAMED_CONFIGS_H_

#include <string_view>
#include <vector>

namespace duet {

// A configuration of model/training/configs, linked into the program.
struct NamedConfig {
  std::string_view name;
  std::string_view json;
};

const std::vector<NamedConfig>& NamedConfigs();

}  // namespace duet

#endif  // DUET_MODEL_TRAINING_NAMED_CONFIGS_H_
