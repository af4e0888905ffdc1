#include "model/engine/standard_window.h"

namespace duet::engine {

NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window) {
  NetworkInput input;
  input.leader = standardisation.Apply(window.leader);
  input.hidden_frames = window.hidden_frames;
  input.labels = window.labels;
  input.sampling = window.options.sampling;
  input.settled = standardisation.Apply(window.settled);
  input.cancelled = window.cancelled.get();
  if (!window.start) return input;
  input.start = FollowerStart{standardisation.Apply(window.start->root), {}};
  for (const motion::Vec3& joint : window.start->pose) {
    input.start->pose.push_back(standardisation.Apply(joint));
  }
  return input;
}

}  // namespace duet::engine
