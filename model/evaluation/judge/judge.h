#ifndef DUET_MODEL_EVALUATION_JUDGE_JUDGE_H_
#define DUET_MODEL_EVALUATION_JUDGE_JUDGE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::judge {

// The people that a classifier sees.
enum class Sees { kFollower, kBoth };

struct MotionClassifierOptions {
  int64_t members = 1;  // networks with different seeds, whose probabilities are averaged
  int64_t hidden = 32;  // LSTM units of each direction, in both layers
  int64_t epochs = 20;
  // Standard deviation of one offset per joint and training motion, metres: makes the classifier
  // independent of people's proportions.
  double body_noise = 0.05;
  Sees sees = Sees::kFollower;
  uint64_t seed = 0;
};

// Classifies a follower's motion: networks shaped like the discriminator, with one output per
// class. A judge is such a classifier that scores synthesised motion (accuracy, FID, diversity);
// the paper's Table 6 trains others on synthetic motion.
//
// It sees, in the standard coordinates of the leader (its root at the origin, -z in the direction
// of the partner, else of its hips), each joint of the follower relative to the leader's root
// (metres) and to the follower's own root, and its velocity in the world (m/s); with Sees::kBoth
// also each joint of the leader relative to its root, and its velocity. All of it follows from the
// first part, but a network does not learn that from a hundred clips: with it, a judge of unseen
// people has an eighth fewer errors.
//
// Source:  paper sections 3.3 and 4 (the paper does not describe its own extractor).
// Threads: the const functions are safe to call concurrently.
class MotionClassifier {
 public:
  // Trains on followers for sequences of the data set, captured or synthesised, each in its
  // sequence's class (`CapturedMotions` gives the captured ones). The same input gives the same
  // result on the same machine. Errors: INVALID_ARGUMENT when a class of the data set has no
  // motion.
  static absl::StatusOr<MotionClassifier> Train(const dataset::Dataset& dataset,
                                                const std::vector<metrics::ScoredMotion>& motions,
                                                const MotionClassifierOptions& options);

  // Judges motions, each requested in its sequence's class. The probabilities of a motion sum to 1.
  // Its features are the second layer's output averaged over the frames, the members' side by side:
  // members * 2 hidden.
  metrics::JudgedFold Judge(const dataset::Dataset& dataset,
                            const std::vector<metrics::ScoredMotion>& motions) const;

 private:
  struct Model;
  explicit MotionClassifier(std::shared_ptr<Model> model) : model_(std::move(model)) {}
  std::shared_ptr<Model> model_;
};

// The latent space of the paper's generator, one point per sequence: the concatenated output of the
// encoders h_t averaged over the frames. (h_t itself is one point per frame; the paper's figures
// show sequences but do not say how frames are combined.) Without a follower start. `labelled`:
// with the label vector of the sequence's class, as in the paper; otherwise zeros.
//
// Source: paper section 3.1 and Figures 6, 7.
// Shapes: returns [sequences][slices x 2 x encoder_hidden].
// Errors: INVALID_ARGUMENT for another generator or one with other classes or joints than the
//         data's.
absl::StatusOr<metrics::FeatureSet> LatentFeatures(const checkpoint::Checkpoint& checkpoint,
                                                   const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences,
                                                   bool labelled);

}  // namespace duet::evaluation::judge

#endif  // DUET_MODEL_EVALUATION_JUDGE_JUDGE_H_
