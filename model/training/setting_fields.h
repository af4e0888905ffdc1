#ifndef DUET_MODEL_TRAINING_SETTING_FIELDS_H_
#define DUET_MODEL_TRAINING_SETTING_FIELDS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/base/strict_json.h"
#include "model/training/flow_training.h"
#include "model/training/paper_training.h"

// Reading and writing the fields of a training configuration. Only the files that define settings
// need it.
namespace duet::training {

inline constexpr int64_t kMaxUnits = 4096;
inline constexpr int64_t kMaxEpochs = 1000000;

// Settings by dotted path, with their values as text.
using Description = std::map<std::string, std::string>;

// Reads one of several words.
std::string OneOf(base::ObjectReader* reader, const std::string& key,
                  const std::vector<std::string>& choices);

double Probability(base::ObjectReader* reader, const std::string& key);

// Reads the sections of a configuration that only one method has. Errors are recorded in `root`.
void ReadSections(base::ObjectReader* root, PaperTraining* out);
void ReadSections(base::ObjectReader* root, FlowTraining* out);

// Adds every setting of a method except its architecture.
void Describe(const PaperTraining& paper, Description* out);
void Describe(const FlowTraining& flow, Description* out);

// The shortest text that reads back as the same value.
std::string Text(double value);
std::string Text(bool value);
inline std::string Text(int64_t value) { return std::to_string(value); }

// Reads the object `name` of `root` with `Read(reader, out)`. Errors are recorded in `root`.
template <typename Section, typename Read>
void ReadSection(base::ObjectReader* root, const std::string& name, Section* out, Read read) {
  const nlohmann::json& object = root->Object(name);
  if (!root->ok()) return;
  base::ObjectReader reader(object, name);
  read(&reader, out);
  root->Update(reader.Finish());
}

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_SETTING_FIELDS_H_
