#ifndef DUET_SERVER_REGISTRY_MODEL_SOURCE_H_
#define DUET_SERVER_REGISTRY_MODEL_SOURCE_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"
#include "server/registry/model_repository.h"

namespace duet::server::registry {

// How models are loaded.
struct ModelSource {
  std::string engine;  // for the log and replies (SynthesisHeader): "cpu, bf16, AVX-512"
  ModelLoader load_folder;
  // Loads the embedded models. The default model is the first.
  std::function<absl::StatusOr<std::vector<std::shared_ptr<const engine::Synthesizer>>>()>
      load_embedded;
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_SOURCE_H_
