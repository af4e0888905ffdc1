#ifndef DUET_MODEL_NETWORK_BATCH_H_
#define DUET_MODEL_NETWORK_BATCH_H_

#include <optional>
#include <vector>

#include "model/engine/synthesizer.h"
#include "model/motion/standardise.h"
#include "model/network/generator.h"

namespace duet::network {

// One clip as the network sees it, in the standard frame of its leader.
struct BatchItem {
  std::vector<motion::Vec3> leader;  // [frames, joints]
  std::vector<float> labels;         // [frames, classes]
  std::optional<engine::FollowerStart>
      start;  // relative to the leader's first root, as all positions
};

// A window in a frame of its leader.
BatchItem StandardItem(const motion::Standardisation& frame, const engine::SynthesisWindow& window);

// Pads clips of different lengths into one batch. Shapes: T is the longest clip's frames.
GeneratorInput MakeInput(const checkpoint::Manifest& manifest, const std::vector<BatchItem>& items);

// Positions padded with zeros: [N, T, 3 J].
torch::Tensor PadPositions(const std::vector<const std::vector<motion::Vec3>*>& clips, int joints,
                           int64_t frames);

// The first `frames` frames of one clip of a batch [N, T, 3 J].
std::vector<motion::Vec3> TakePositions(const torch::Tensor& batch, int64_t clip, int64_t frames);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_BATCH_H_
