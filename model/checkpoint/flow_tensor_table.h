#ifndef DUET_MODEL_CHECKPOINT_FLOW_TENSOR_TABLE_H_
#define DUET_MODEL_CHECKPOINT_FLOW_TENSOR_TABLE_H_

#include <vector>

#include "model/checkpoint/manifest.h"

namespace duet::checkpoint {

// Sines and cosines that tell the sampling generator how far from noise to motion it is.
inline constexpr int kTimeFeatures = 32;
// How far a frame is from the window's ends and how long the window is.
inline constexpr int kPositionFeatures = 4;

// The tensors of a sampling generator; ExpectedTensors has the table. Requires manifest.flow.
std::vector<TensorSpec> FlowTensors(const Manifest& manifest);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_FLOW_TENSOR_TABLE_H_
