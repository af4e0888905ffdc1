#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZER_METHOD_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZER_METHOD_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/protocol/method.h"
#include "model/motion/poses.h"

namespace duet::evaluation::experiments {

// Whether a model answers a data set's clips: FAILED_PRECONDITION when its classes or joints are
// not the data's.
absl::Status CheckModelFits(const engine::ModelDescription& model, const dataset::Dataset& dataset);

// What a synthesizer is told of the follower's first frame.
enum class StartGiven { kNone, kRoot, kPose };

// CheckModelFits, and FAILED_PRECONDITION for a start that the model does not accept.
absl::Status CheckModelTakes(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                             StartGiven start);

// A trained model as a row of the tables, run as a server runs it: in windows that are blended.
class SynthesizerMethod : public protocol::Method {
 public:
  // `synthesizer` was trained on the fold's training sequences alone. Requires a model that accepts
  // a follower start unless `start` is kNone.
  SynthesizerMethod(std::string name, std::shared_ptr<const engine::Synthesizer> synthesizer,
                    StartGiven start);

  std::string name() const override { return name_; }
  // Checks that the model fits the data; the training is done already.
  absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) override;
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override;
  bool reads_first_pose() const override { return start_ != StartGiven::kNone; }

 private:
  std::string name_;
  std::shared_ptr<const engine::Synthesizer> synthesizer_;
  StartGiven start_;
};

// The follower for a leader and any label vector ([classes]), made in the same way. Errors: those
// of the network.
absl::StatusOr<motion::Poses> SynthesizeSequence(const engine::Synthesizer& synthesizer,
                                                 const dataset::Sequence& sequence,
                                                 const std::vector<float>& labels,
                                                 StartGiven start);

// A leader, the label vector ([classes]) to answer it with, and which of the answers is wanted.
struct LabelledLeader {
  const dataset::Sequence* sequence;
  std::vector<float> labels;
  engine::Sampling sampling = {};
  // False: where the partner is is left to the leader's motion, as by a caller who tells nothing.
  bool tell_direction = true;
};

// The same for many leaders, several windows to an evaluation of the network: much faster than one
// by one. Returns a follower for each, in order; a failure of one is a failure of all.
absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    StartGiven start);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZER_METHOD_H_
