#ifndef DUET_MODEL_EMBEDDED_EMBEDDED_H_
#define DUET_MODEL_EMBEDDED_EMBEDDED_H_

#include <string_view>
#include <vector>

namespace duet::embedded {

// A checkpoint linked into the program: what ReadCheckpoint would read from its folder.
struct EmbeddedCheckpoint {
  std::string_view manifest;  // manifest.json
  std::string_view weights;   // weights.safetensors
};

// Every checkpoint of model/embedded, the default model first.
std::vector<EmbeddedCheckpoint> EmbeddedCheckpoints();

}  // namespace duet::embedded

#endif  // DUET_MODEL_EMBEDDED_EMBEDDED_H_
