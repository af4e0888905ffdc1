#ifndef DUET_MODEL_ENGINE_MIXTURE_H_
#define DUET_MODEL_ENGINE_MIXTURE_H_

#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/engine/model_description.h"
#include "model/engine/network.h"
#include "model/motion/poses.h"

namespace duet::engine {

// What several labels ask for at once, and how much a leader moves its follower: the evaluations of
// the network that a window needs, and how their answers become one (docs/decisions/mixing.md).
//
// Only for models whose labels guide (ModelDescription::labels_guide); for others, the window is
// evaluated once, as it is. One label above 0 and a reaction of 1 give the network's own answer.
//
// - Classes of contact (an embrace, hands that meet) and others share the time: contact until the
//   leader has reached out furthest, then the other answer's displacement from where the body is. A
//   weight of one half has half of the time, at full strength; 1 has all of it. Classes of the same
//   kind are averaged by the network.
// - Of an avoided class, only what does not concern the request is subtracted: for a weight of -1,
//   at most half as much as the request moves the follower. Without a request, all of it is.
// - Reaction is a factor of the difference that the leader's motion makes.
//
// Every evaluation has the same noise, and the frames that the window continues from.
// Shapes: T frames, C classes. Coordinates: standard (NetworkInput), the partner at -z.
class Mixture {
 public:
  // `body`: the limbs of the model's skeleton.
  Mixture(const ModelDescription& model, const body::Body& body, const NetworkInput& window);

  // Appends the evaluations of the window, at least one. They differ from `window`, which has to be
  // that of the constructor but for its noise, in labels and leader.
  void AddInputs(const NetworkInput& window, std::vector<NetworkInput>* inputs) const;

  // Number of inputs that AddInputs appends.
  std::size_t evaluations() const { return parts_.size() * (reaction_ == 1 ? 1 : 2); }

  // The answer to the window. `answers`: to the inputs of AddInputs, in order.
  motion::Poses Combine(absl::Span<const motion::Poses> answers) const;

  // The weights that the answer has in each frame, [T, C]: those of the window, except for classes
  // that share the time.
  const std::vector<float>& labels() const { return labels_; }

 private:
  using Labels = std::vector<float>;  // [T, C]

  void FindParts(const ModelDescription& model, const body::Body& body, const NetworkInput& window);
  void ShareTime(const Labels& contact, const Labels& other, const std::vector<float>& phase,
                 float clear);
  motion::Poses Mix(absl::Span<const motion::Poses> answers) const;
  motion::Poses InTime(const motion::Poses& contact, const motion::Poses& other,
                       const motion::Poses& neutral) const;
  void Subtract(const motion::Poses& neutral, absl::Span<const motion::Poses> avoided,
                motion::Poses* answer) const;

  int frames_, classes_, root_, known_frames_;
  float reaction_;
  Labels weights_;  // of the window
  Labels labels_;
  // What is asked for, in one or two parts; then, if there are two or any is avoided, nothing; then
  // each avoided class.
  std::vector<Labels> parts_;
  std::vector<int> avoided_;
  std::vector<float> contact_, other_;  // [T] of the two parts; empty: there is one
  std::vector<float> requested_;        // [T] how much is asked for, 0 to 1
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_MIXTURE_H_
