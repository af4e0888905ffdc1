#ifndef DUET_MODEL_EVALUATION_JUDGE_MOTION_CLASSIFIER_H_
#define DUET_MODEL_EVALUATION_JUDGE_MOTION_CLASSIFIER_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/classifier/classifier.h"
#include "model/classifier/classifier_input.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::judge {

struct MotionClassifierOptions {
  int64_t members = 1;  // networks with different seeds, whose probabilities are averaged
  int64_t hidden = 32;  // LSTM units of each direction, in both layers
  int64_t epochs = 20;
  int64_t batch = 16;
  double learning_rate = 2e-3;
  double weight_decay = 0.01;
  double dropout = 0.3;
  // Standard deviation of one offset per joint and training motion, metres: makes the classifier
  // independent of people's proportions.
  double body_noise = 0.05;
  classifier::Sees sees = classifier::Sees::kFollower;
  uint64_t seed = 0;
};

// Classifies a follower's motion: networks shaped like the discriminator, with one output per
// class. A judge is such a classifier that scores synthesised motion (accuracy, FID, diversity);
// the paper's Table 6 trains others on synthetic motion. By default it sees only the follower, in
// the standard coordinates of its leader (ClassifierInput).
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

  // Shapes: returns [motions][classes]; every row sums to 1.
  std::vector<std::vector<float>> Probabilities(
      const dataset::Dataset& dataset, const std::vector<metrics::ScoredMotion>& motions) const;
  // The second layer's output averaged over the frames, the members' side by side. Shapes: returns
  // [motions][members * 2 hidden].
  metrics::FeatureSet Features(const dataset::Dataset& dataset,
                               const std::vector<metrics::ScoredMotion>& motions) const;

  // The parts that model/classifier runs without LibTorch. Requires a judge that sees only the
  // follower, and the data set of Train.
  classifier::ClassifierParts Parts(const dataset::Dataset& dataset) const;

  // SHA-256 of all weights, in hexadecimal: identifies the extractor of a figure.
  const std::string& hash() const;

 private:
  struct Model;
  explicit MotionClassifier(std::shared_ptr<Model> model) : model_(std::move(model)) {}
  std::shared_ptr<Model> model_;
};

}  // namespace duet::evaluation::judge

#endif  // DUET_MODEL_EVALUATION_JUDGE_MOTION_CLASSIFIER_H_
