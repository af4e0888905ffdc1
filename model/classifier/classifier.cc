#include "model/classifier/classifier.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/classifier/classifier_input.h"
#include "model/motion/resample.h"

namespace duet::classifier {
namespace {

using checkpoint::Tensor;

// Far above the result of any training, and low enough that sums cannot overflow.
constexpr float kLargestWeight = 1e6f;

// Finds tensors by name and checks their shapes.
class TensorTable {
 public:
  explicit TensorTable(const std::vector<Tensor>& tensors) {
    for (const Tensor& tensor : tensors) table_[tensor.name] = &tensor;
  }

  const std::vector<float>& Find(const std::string& name, const std::vector<int64_t>& shape) {
    static const auto& none = *new std::vector<float>();
    const auto found = table_.find(name);
    ++found_;
    if (found != table_.end() && found->second->shape == shape) return found->second->values;
    if (status_.ok()) {
      status_ = absl::InvalidArgumentError(absl::StrCat(
          "tensors: ", name, ": expected shape ", absl::StrJoin(shape, " x "), ", got ",
          found == table_.end() ? "none" : absl::StrJoin(found->second->shape, " x ")));
    }
    return none;
  }

  // An error if a tensor was not found or others remain.
  absl::Status status() const {
    if (!status_.ok() || found_ == table_.size()) return status_;
    return absl::InvalidArgumentError(
        absl::StrCat("tensors: expected ", found_, ", got ", table_.size()));
  }

 private:
  std::map<std::string, const Tensor*> table_;
  std::size_t found_ = 0;
  absl::Status status_;
};

// Transposes one of the two matrices [rows, columns] of a tensor.
std::vector<float> Transposed(const std::vector<float>& values, int which, int rows, int columns) {
  std::vector<float> out;
  if (values.empty()) return out;
  const float* const matrix = values.data() + std::ptrdiff_t{which} * rows * columns;
  out.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      out[static_cast<std::size_t>(column * rows + row)] = matrix[row * columns + column];
    }
  }
  return out;
}

// out += in x matrix [inputs, outputs]. With rows outermost, the sums are independent of each
// other.
void AddProduct(const float* in, int inputs, const std::vector<float>& matrix, int outputs,
                float* out) {
  const float* row = matrix.data();
  for (int i = 0; i < inputs; ++i, row += outputs) {
    const float value = in[i];
    for (int o = 0; o < outputs; ++o) out[o] += value * row[o];
  }
}

float Sigmoid(float x) { return 1 / (1 + std::exp(-x)); }

// Source: Hochreiter, Schmidhuber 1997, with forget gates. Gates i f g o.
void LstmStep(const float* gates, int hidden, float* cell, float* state) {
  for (int u = 0; u < hidden; ++u) {
    const float in = Sigmoid(gates[u]), forget = Sigmoid(gates[hidden + u]);
    const float value = std::tanh(gates[2 * hidden + u]), out = Sigmoid(gates[3 * hidden + u]);
    cell[u] = forget * cell[u] + in * value;
    state[u] = out * std::tanh(cell[u]);
  }
}

void Softmax(std::vector<float>* values) {
  const float largest = *std::max_element(values->begin(), values->end());
  float sum = 0;
  for (float& value : *values) sum += value = std::exp(value - largest);
  for (float& value : *values) value /= sum;
}

motion::Clip AtRate(const motion::Clip& clip, double rate_hz) {
  motion::Clip out = clip;
  if (clip.frame_rate_hz != rate_hz && clip.frame_count() > 1) {
    out.poses = motion::Resample(clip.poses, clip.frame_rate_hz, rate_hz);
  }
  out.frame_rate_hz = rate_hz;
  return out;
}

motion::Clip Part(const motion::Clip& clip, int first, int frames) {
  motion::Clip part;
  part.joint_names = clip.joint_names;
  part.frame_rate_hz = clip.frame_rate_hz;
  part.poses = motion::Poses(0, clip.joint_count());
  part.poses.Append(clip.poses.frames(first, frames));
  return part;
}

absl::Status CheckSizes(const ClassifierParts& parts) {
  const auto refuse = [](const char* field, double got, const char* expected) {
    return absl::InvalidArgumentError(absl::StrCat(field, ": expected ", expected, ", got ", got));
  };
  if (parts.classes.size() < 2) {
    return refuse("classes", static_cast<double>(parts.classes.size()), "2 or more");
  }
  if (!(parts.frame_rate_hz > 0))
    return refuse("frame_rate_hz", parts.frame_rate_hz, "more than 0");
  if (parts.window_frames < 1) return refuse("window_frames", parts.window_frames, "1 or more");
  if (parts.hidden < 1) return refuse("hidden", parts.hidden, "1 or more");
  if (parts.networks < 1) return refuse("networks", parts.networks, "1 or more");
  for (const Tensor& tensor : parts.tensors) {
    for (const float weight : tensor.values) {
      if (!(std::abs(weight) <= kLargestWeight)) {
        return refuse(tensor.name.c_str(), weight, "-1e6 to 1e6");
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Classifier> Classifier::Create(ClassifierParts parts) {
  absl::Status status = CheckSizes(parts);
  if (!status.ok()) return status;
  Classifier classifier(std::move(parts));
  status = classifier.TakeNetworks();
  if (!status.ok()) return status;
  return classifier;
}

absl::Status Classifier::TakeNetworks() {
  TensorTable table(parts_.tensors);
  const int hidden = parts_.hidden, gates = 4 * hidden;
  const int inputs[] = {3 * InputParts(Sees::kFollower) * parts_.skeleton.joint_count(),
                        2 * hidden};
  const auto classes = static_cast<int64_t>(parts_.classes.size());
  for (int n = 0; n < parts_.networks; ++n) {
    Network network;
    for (int layer = 0; layer < 2; ++layer) {
      const std::string at = absl::StrCat(n, ".layer", layer + 1, "_");
      const auto& input = table.Find(at + "weight_ih", {2, gates, inputs[layer]});
      const auto& recurrent = table.Find(at + "weight_hh", {2, gates, hidden});
      const auto& bias = table.Find(at + "bias", {2, gates});
      for (int d = 0; d < 2; ++d) {
        Direction& direction = network.layers[layer][d];
        direction.input = Transposed(input, d, gates, inputs[layer]);
        direction.recurrent = Transposed(recurrent, d, gates, hidden);
        direction.bias = Transposed(bias, d, gates, 1);
      }
    }
    network.output_weight = table.Find(absl::StrCat(n, ".output.weight"),
                                       {classes, int64_t{parts_.window_frames} * 2 * hidden});
    network.output_bias = table.Find(absl::StrCat(n, ".output.bias"), {classes});
    networks_.push_back(std::move(network));
  }
  return table.status();
}

// Shapes: input [frames, inputs]; returns [frames, 2 H], forward and backward side by side.
std::vector<float> Classifier::RunLayer(const Direction (&layer)[2],
                                        const std::vector<float>& input, int frames) const {
  const int hidden = parts_.hidden;
  const int inputs = static_cast<int>(input.size()) / frames;
  std::vector<float> output(static_cast<std::size_t>(frames * 2 * hidden));
  for (int d = 0; d < 2; ++d) {
    std::vector<float> state(static_cast<std::size_t>(hidden)), cell(state), gates;
    for (int step = 0; step < frames; ++step) {
      const int frame = d == 0 ? step : frames - 1 - step;
      gates = layer[d].bias;
      AddProduct(&input[static_cast<std::size_t>(frame * inputs)], inputs, layer[d].input,
                 4 * hidden, gates.data());
      AddProduct(state.data(), hidden, layer[d].recurrent, 4 * hidden, gates.data());
      LstmStep(gates.data(), hidden, cell.data(), state.data());
      std::copy(state.begin(), state.end(),
                &output[static_cast<std::size_t>((frame * 2 + d) * hidden)]);
    }
  }
  return output;
}

std::vector<float> Classifier::RunNetwork(const Network& network,
                                          const motion::Poses& input) const {
  const int frames = input.frame_count();
  std::vector<float> values;
  for (const motion::Vec3& vector : input.all()) {
    values.insert(values.end(), {vector.x, vector.y, vector.z});
  }
  for (const auto& layer : network.layers) values = RunLayer(layer, values, frames);
  // Frames after the clip's end count as zero.
  const std::size_t columns =
      network.output_weight.size() / std::max<std::size_t>(network.output_bias.size(), 1);
  std::vector<float> probabilities = network.output_bias;
  for (std::size_t c = 0; c < probabilities.size(); ++c) {
    const float* const weights = &network.output_weight[c * columns];
    for (std::size_t i = 0; i < values.size(); ++i) probabilities[c] += weights[i] * values[i];
  }
  Softmax(&probabilities);
  return probabilities;
}

std::vector<float> Classifier::Probabilities(const motion::ClipPair& pair) const {
  const motion::ClipPair at_rate = {AtRate(pair.leader, parts_.frame_rate_hz),
                                    AtRate(pair.follower, parts_.frame_rate_hz)};
  const int frames = at_rate.follower.frame_count();
  const int window = std::min(frames, parts_.window_frames);
  std::vector<float> mean(parts_.classes.size());
  int count = 0;
  for (int from = 0; from < frames; from += window) {
    const int first = std::min(from, frames - window);
    const motion::ClipPair part = {Part(at_rate.leader, first, window),
                                   Part(at_rate.follower, first, window)};
    const motion::Poses input =
        ClassifierInput(parts_.skeleton, part, DirectionToFollower(parts_.skeleton, part));
    for (const Network& network : networks_) {
      const std::vector<float> one = RunNetwork(network, input);
      for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += one[c];
      ++count;
    }
  }
  for (float& value : mean) value /= static_cast<float>(count);
  return mean;
}

}  // namespace duet::classifier
