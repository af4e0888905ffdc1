#include "tests/classifier/random_classifier.h"

#include <string>

#include "model/base/random.h"
#include "model/classifier/classifier_input.h"

namespace duet::test {

classifier::ClassifierParts RandomClassifier(int networks, int hidden) {
  classifier::ClassifierParts parts;
  parts.classes = {"kick", "hug"};
  parts.skeleton = motion::SbuSkeleton();
  parts.frame_rate_hz = 15;
  parts.window_frames = 20;
  parts.hidden = hidden;
  parts.networks = networks;
  base::Random random(7);
  const auto add = [&](const std::string& name, std::vector<int64_t> shape) {
    int64_t count = 1;
    for (const int64_t size : shape) count *= size;
    checkpoint::Tensor tensor{name, std::move(shape), {}};
    for (int64_t i = 0; i < count; ++i) {
      tensor.values.push_back(static_cast<float>(random.Normal(0.5)));
    }
    parts.tensors.push_back(std::move(tensor));
  };
  const int64_t inputs =
      3 * classifier::InputParts(classifier::Sees::kFollower) * parts.skeleton.joint_count();
  for (int n = 0; n < networks; ++n) {
    const std::string network = std::to_string(n) + ".";
    for (const auto& [layer, count] : {std::pair<std::string, int64_t>{"layer1_", inputs},
                                       std::pair<std::string, int64_t>{"layer2_", 2 * hidden}}) {
      add(network + layer + "weight_ih", {2, 4 * hidden, count});
      add(network + layer + "weight_hh", {2, 4 * hidden, hidden});
      add(network + layer + "bias", {2, 4 * hidden});
    }
    add(network + "output.weight", {2, parts.window_frames * 2 * hidden});
    add(network + "output.bias", {2});
  }
  return parts;
}

}  // namespace duet::test
