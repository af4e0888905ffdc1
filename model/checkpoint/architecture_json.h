#ifndef DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_
#define DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_

#include <nlohmann/json.hpp>

#include "model/base/strict_json.h"
#include "model/checkpoint/architecture.h"

// Architectures as JSON, in manifests and training configurations. Only the code that reads or
// writes those files needs it.
namespace duet::checkpoint {

// The field of a JSON object that names its architecture.
inline constexpr char kArchitectureKind[] = "kind";

// Reads the fields of "generator". An object without a kind is the paper's: version 1 of the
// format had no other, and training configurations may omit it. Errors are recorded in the reader.
Architecture ReadArchitecture(bool has_kind, base::ObjectReader* reader);

// Includes the kind.
nlohmann::ordered_json ToJson(const Architecture& architecture);

// The same for each alternative. ReadFields reads every field except the kind.
void ReadFields(base::ObjectReader* reader, PaperArchitecture* out);
nlohmann::ordered_json ToJson(const PaperArchitecture& paper);

void ReadFields(base::ObjectReader* reader, FlowArchitecture* out);
nlohmann::ordered_json ToJson(const FlowArchitecture& flow);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_ARCHITECTURE_JSON_H_
