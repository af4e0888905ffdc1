#ifndef DUET_MODEL_CHECKPOINT_FLOW_JSON_H_
#define DUET_MODEL_CHECKPOINT_FLOW_JSON_H_

#include <nlohmann/json.hpp>

#include "model/base/strict_json.h"
#include "model/checkpoint/flow_architecture.h"

// The sampling generator as manifests and training configurations write it.
namespace duet::checkpoint {

// The field that says which generator an object describes, and its values.
inline constexpr char kGeneratorKind[] = "kind";
inline constexpr char kPaperKind[] = "paper";
inline constexpr char kFlowKind[] = "flow";

// Reads every field but the kind. What is wrong is the reader's to tell.
FlowArchitecture ReadFlowArchitecture(base::ObjectReader* reader);

// With the kind.
nlohmann::ordered_json FlowArchitectureToJson(const FlowArchitecture& flow);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_FLOW_JSON_H_
