#ifndef DUET_MODEL_CHECKPOINT_CRITIC_TENSORS_H_
#define DUET_MODEL_CHECKPOINT_CRITIC_TENSORS_H_

#include <optional>
#include <string_view>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/engine/critic.h"
#include "model/engine/model_description.h"

namespace duet::checkpoint {

// The critic's tensors have names that begin with this.
inline constexpr std::string_view kCriticPrefix = "critic.";

// The tensors of a critic, with U = 16 units and I = 9 joints + classes:
//   critic.frames.weight, .bias   [U, I], [U]
//   critic.near.weight, .bias     [U, U, 3], [U]
//   critic.far.weight, .bias      [U, U, 3], [U]
//   critic.output.weight, .bias   [1, U], [1]
std::vector<TensorSpec> CriticTensors(const engine::ModelDescription& model);

// The checkpoint's critic, if it has one. Requires tensors that ParseCheckpoint accepts.
std::optional<engine::Critic> CriticOf(const Checkpoint& checkpoint);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_CRITIC_TENSORS_H_
