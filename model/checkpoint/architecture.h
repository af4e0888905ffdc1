#ifndef DUET_MODEL_CHECKPOINT_ARCHITECTURE_H_
#define DUET_MODEL_CHECKPOINT_ARCHITECTURE_H_

#include <string_view>
#include <variant>

#include "model/checkpoint/flow_architecture.h"
#include "model/checkpoint/paper_architecture.h"

namespace duet::checkpoint {

// Every architecture of a generator: its sizes, and what its files contain. An alternative T has
//   T::kKind       its name in "generator.kind" of manifests and training configurations
//   T::kSummary    one line for model cards
//   T::kSamples    whether answers depend on a seed
//   AcceptsFollowerStart()
//   LabelsGuide()           // ModelDescription::labels_guide
//   Tensors(manifest, T), declared beside T
//   ReadFields and ToJson, declared in architecture_json.h
// All that dispatches on the variant in this layer is architecture.cc. The layers above register
// each alternative in one place each; docs/guides/add_a_model_architecture.md lists them.
using Architecture = std::variant<PaperArchitecture, FlowArchitecture>;

// One line for model cards.
std::string_view Summary(const Architecture& architecture);

// Sets the architecture, and in manifest->model what follows from it: `samples` and
// `accepts_follower_start`.
void SetArchitecture(const Architecture& architecture, Manifest* manifest);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_ARCHITECTURE_H_
