#include "model/engine/standard_window.h"

namespace duet::engine {

NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window) {
  NetworkInput input{standardisation.Apply(window.leader), window.labels, std::nullopt};
  if (!window.start) return input;
  input.start = FollowerStart{standardisation.Apply(window.start->root), {}};
  for (const motion::Vec3& joint : window.start->pose) {
    input.start->pose.push_back(standardisation.Apply(joint));
  }
  return input;
}

}  // namespace duet::engine
