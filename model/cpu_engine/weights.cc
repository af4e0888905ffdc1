#include "model/cpu_engine/weights.h"

#include <cstddef>

namespace duet::cpu_engine {
namespace {

std::size_t At(int row, int columns, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

}  // namespace

Layer Chained(const Layer& first, const Layer& second) {
  Layer both;
  both.outputs = second.outputs;
  both.inputs = first.inputs;
  both.weight.resize(At(second.outputs, first.inputs, 0));
  both.bias = second.bias;
  both.bias.resize(static_cast<std::size_t>(second.outputs));
  std::vector<double> row(static_cast<std::size_t>(first.inputs));
  for (int n = 0; n < second.outputs; ++n) {
    row.assign(row.size(), 0);
    double bias = both.bias[static_cast<std::size_t>(n)];
    for (int m = 0; m < first.outputs; ++m) {
      const double factor = second.weight[At(n, second.inputs, m)];
      if (!first.bias.empty()) bias += factor * first.bias[static_cast<std::size_t>(m)];
      for (int k = 0; k < first.inputs; ++k) {
        row[static_cast<std::size_t>(k)] += factor * first.weight[At(m, first.inputs, k)];
      }
    }
    both.bias[static_cast<std::size_t>(n)] = static_cast<float>(bias);
    for (int k = 0; k < first.inputs; ++k) {
      both.weight[At(n, first.inputs, k)] = static_cast<float>(row[static_cast<std::size_t>(k)]);
    }
  }
  return both;
}

Layer Stacked(const Layer& above, const Layer& below) {
  Layer both = above;
  both.outputs += below.outputs;
  both.weight.insert(both.weight.end(), below.weight.begin(), below.weight.end());
  both.bias.insert(both.bias.end(), below.bias.begin(), below.bias.end());
  return both;
}

Weights::Weights(const checkpoint::Checkpoint& checkpoint) {
  for (const checkpoint::Tensor& tensor : checkpoint.tensors) tensors_[tensor.name] = &tensor;
}

const std::vector<float>& Weights::Values(const std::string& name) const {
  return tensors_.at(name)->values;
}

Layer Weights::FindLayer(const std::string& weight, const std::string& bias) const {
  const checkpoint::Tensor& tensor = *tensors_.at(weight);
  return {tensor.values, bias.empty() ? std::vector<float>() : Values(bias),
          static_cast<int>(tensor.shape[0]), static_cast<int>(tensor.shape[1])};
}

Layer Weights::FindLayer(const std::string& name) const {
  return FindLayer(name + ".weight", name + ".bias");
}

}  // namespace duet::cpu_engine
