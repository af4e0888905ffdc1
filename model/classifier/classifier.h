#ifndef DUET_MODEL_CLASSIFIER_CLASSIFIER_H_
#define DUET_MODEL_CLASSIFIER_CLASSIFIER_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/safetensors.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::classifier {

// The content of a classifier: networks of one shape, each trained from its own seed. Their
// probabilities are averaged.
//
// Shapes: F window_frames, H hidden, I = InputParts(kFollower) x 3 joints, C classes. Network n has
//         the tensors "n.layer1_weight_ih" [2, 4 H, I], "n.layer1_weight_hh" [2, 4 H, H],
//         "n.layer1_bias" [2, 4 H], the same for layer2 with 2 H instead of I, "n.output.weight"
//         [C, F x 2 H], "n.output.bias" [C]. Both directions, forward first; gates i f g o.
struct ClassifierParts {
  std::vector<std::string> classes;
  motion::Skeleton skeleton;
  double frame_rate_hz = 0;
  int window_frames = 0;
  int hidden = 0;
  int networks = 1;
  std::vector<checkpoint::Tensor> tensors;
};

// Classifies a follower's motion: runs the judge of model/evaluation/judge without LibTorch, for
// programs that do not link it.
//
// Source:  paper sections 3.3 and 4; model/network/discriminator.h has the network in LibTorch.
// Threads: const methods are safe to call concurrently.
class Classifier {
 public:
  // Errors: INVALID_ARGUMENT naming the tensor or the field, its value and what was expected.
  static absl::StatusOr<Classifier> Create(ClassifierParts parts);

  const ClassifierParts& parts() const { return parts_; }

  // The probabilities of the classes. For a clip longer than the window, the mean over its windows;
  // the last window ends at the clip's end. The pair may have any rate. Requires at least one
  // frame, and the skeleton's joints in its order. Shapes: returns [classes], with the sum 1.
  std::vector<float> Probabilities(const motion::ClipPair& pair) const;

 private:
  // The weights of one direction of a layer, inputs outermost.
  struct Direction {
    std::vector<float> input;      // [I, 4 H]
    std::vector<float> recurrent;  // [H, 4 H]
    std::vector<float> bias;       // [4 H]
  };
  struct Network {
    Direction layers[2][2];
    std::vector<float> output_weight, output_bias;
  };

  explicit Classifier(ClassifierParts parts) : parts_(std::move(parts)) {}
  absl::Status TakeNetworks();
  std::vector<float> RunLayer(const Direction (&layer)[2], const std::vector<float>& input,
                              int frames) const;
  std::vector<float> RunNetwork(const Network& network, const motion::Poses& input) const;

  ClassifierParts parts_;
  std::vector<Network> networks_;
};

}  // namespace duet::classifier

#endif  // DUET_MODEL_CLASSIFIER_CLASSIFIER_H_
