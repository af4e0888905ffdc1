#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZER_METHOD_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZER_METHOD_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/protocol/method.h"

namespace duet {

// Whether a model answers a data set's clips: FAILED_PRECONDITION when its classes or joints are
// not the data's.
absl::Status CheckModelFits(const ModelDescription& model, const Dataset& dataset);

// What a synthesizer is told of the follower's first frame.
enum class StartGiven { kNone, kRoot, kPose };

// A trained model as a row of the tables, run the way a server runs it: windows, blending and all.
class SynthesizerMethod : public Method {
 public:
  // `synthesizer` was trained on the fold's training sequences alone. Requires a model that accepts
  // a follower start unless `start` is kNone.
  SynthesizerMethod(std::string name, std::shared_ptr<const Synthesizer> synthesizer,
                    StartGiven start);

  std::string name() const override { return name_; }
  // Checks that the model fits the data; the training is done already.
  absl::Status Train(const Dataset& dataset, const std::vector<int>& train) override;
  // Empty when the network fails.
  std::vector<Vec3> Predict(const Sequence& sequence) const override;
  bool reads_first_pose() const override { return start_ != StartGiven::kNone; }

 private:
  std::string name_;
  std::shared_ptr<const Synthesizer> synthesizer_;
  StartGiven start_;
};

// The follower for a leader and any label vector ([classes]), through the same path. A failure of
// the network is its status.
absl::StatusOr<std::vector<Vec3>> SynthesizeSequence(const Synthesizer& synthesizer,
                                                     const Sequence& sequence,
                                                     const std::vector<float>& labels,
                                                     StartGiven start);

// A leader and the label vector ([classes]) to answer it with.
struct LabelledLeader {
  const Sequence* sequence;
  std::vector<float> labels;
};

// The same for many, several windows to an evaluation of the network: much faster than one by one.
// Returns a follower each, in order; the first failure is the whole call's.
absl::StatusOr<std::vector<std::vector<Vec3>>> SynthesizeSequences(
    const Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders, StartGiven start);

}  // namespace duet

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZER_METHOD_H_
