#ifndef DUET_MODEL_TRAINING_OPTIONS_H_
#define DUET_MODEL_TRAINING_OPTIONS_H_

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/architecture.h"
#include "model/dataset/dataset.h"
#include "model/motion/standardise.h"
#include "model/training/settings.pb.h"

namespace duet::training {

// All settings of a training run. settings.proto declares most of them, with their ranges and
// defaults. The named configurations are in model/training/configs.
struct TrainingOptions {
  checkpoint::Architecture architecture;
  motion::StandardOrigin standardisation = motion::StandardOrigin::kEveryFrame;
  CommonSettings common;
  PaperSettings paper;  // only with a checkpoint::PaperArchitecture
  FlowSettings flow;    // only with a checkpoint::FlowArchitecture
};

// The settings of a sampling generator; null for another.
inline const FlowSettings* FlowIn(const TrainingOptions& options) {
  return std::holds_alternative<checkpoint::FlowArchitecture>(options.architecture) ? &options.flow
                                                                                    : nullptr;
}

// Whether any clip gets pauses or people at rest (augment.h).
inline bool UsesStillness(const FlowSettings& flow) {
  const FlowSettings::Stillness& shares = flow.stillness();
  return shares.pauses() + shares.ends() + shares.motionless() + shares.unlabelled() > 0;
}

// A configuration of model/training/configs, linked into the program.
struct NamedConfig {
  std::string_view name;
  std::string_view json;
};

const std::vector<NamedConfig>& NamedConfigs();

// The configuration of this name, or null.
const NamedConfig* FindConfig(std::string_view name);

// Parses a configuration, after replacing fields by dotted path: {"losses.bone", "0.01"}; values
// are JSON, or plain words. It has all settings without a default, or the differences from a named
// configuration: {"base": "default", "set": {"losses.bone": 0}}. An unknown or missing field or a
// value out of range is INVALID_ARGUMENT naming the field, its value and the range.
absl::StatusOr<TrainingOptions> ParseConfig(
    std::string_view json,
    const std::vector<std::pair<std::string, std::string>>& replacements = {});

// Every setting by dotted path, as a manifest stores it.
std::map<std::string, std::string> Describe(const TrainingOptions& options);

// Checks what depends on the data: held-out subjects must exist, and mirroring requires joint names
// that distinguish left and right.
absl::Status CheckAgainst(const TrainingOptions& options, const dataset::Dataset& dataset);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_OPTIONS_H_
