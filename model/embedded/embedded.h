#ifndef DUET_MODEL_EMBEDDED_EMBEDDED_H_
#define DUET_MODEL_EMBEDDED_EMBEDDED_H_

#include <string_view>
#include <vector>

namespace duet::embedded {

// A checkpoint linked into the program: the content of its files.
struct EmbeddedCheckpoint {
  std::string_view manifest;  // manifest.json
  std::string_view weights;   // weights.safetensors
};

// All checkpoints of model/embedded, the default model first.
std::vector<EmbeddedCheckpoint> EmbeddedCheckpoints();

}  // namespace duet::embedded

#endif  // DUET_MODEL_EMBEDDED_EMBEDDED_H_
