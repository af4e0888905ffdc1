#ifndef DUET_MODEL_TORCH_PLUGIN_TORCH_PLUGIN_H_
#define DUET_MODEL_TORCH_PLUGIN_TORCH_PLUGIN_H_

#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"

namespace duet::torch_plugin {

// The functions of model/torch_engine/torch_synthesizer.h, from a library that is loaded on demand:
// loading LibTorch takes 0.4 s and 160 MB, and most servers do not use it.
struct TorchEngine {
  absl::Status (*set_threads)(int threads);
  absl::StatusOr<std::unique_ptr<engine::Synthesizer>> (*load_folder)(
      const std::filesystem::path& folder);
  absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> (*load_embedded)();
};

// Loads libduet_torch_engine.so and never unloads it: from $DUET_TORCH_ENGINE, else from
// ../lib/duet beside the program. NOT_FOUND with the loader's message; FAILED_PRECONDITION if it is
// of another build.
absl::StatusOr<TorchEngine> Open();

// The library exports this under the name kSymbol. `build` identifies its build: both sides must
// have the same one, because they exchange C++ classes.
inline constexpr char kSymbol[] = "duet_torch_engine";
struct Exported {
  const char* build;
  TorchEngine engine;
};

}  // namespace duet::torch_plugin

#endif  // DUET_MODEL_TORCH_PLUGIN_TORCH_PLUGIN_H_
