#include "model/checkpoint/critic_tensors.h"

#include <cstddef>
#include <cstdint>

namespace duet::checkpoint {

std::vector<TensorSpec> CriticTensors(const engine::ModelDescription& model) {
  constexpr int64_t kUnits = engine::kCriticUnits, kKernel = engine::kCriticKernel;
  return {
      {"critic.frames.weight", {kUnits, engine::CriticInputs(model.skeleton, model.class_count())}},
      {"critic.frames.bias", {kUnits}},
      {"critic.near.weight", {kUnits, kUnits, kKernel}},
      {"critic.near.bias", {kUnits}},
      {"critic.far.weight", {kUnits, kUnits, kKernel}},
      {"critic.far.bias", {kUnits}},
      {"critic.output.weight", {1, kUnits}},
      {"critic.output.bias", {1}}};
}

std::optional<engine::Critic> CriticOf(const Checkpoint& checkpoint) {
  if (checkpoint.critic.empty()) return std::nullopt;
  const auto values = [&](std::size_t i) { return checkpoint.critic[i].values; };
  const engine::ModelDescription& model = checkpoint.manifest.model;
  return engine::Critic(
      model.skeleton, model.frame_rate_hz,
      {values(0), values(1), values(2), values(3), values(4), values(5), values(6), values(7)});
}

}  // namespace duet::checkpoint
