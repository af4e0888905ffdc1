#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_ANSWERS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_ANSWERS_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/engine/label_track.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/metrics/scores.h"
#include "model/motion/poses.h"

namespace duet::evaluation::experiments {

// Checks that a model can answer a data set's clips. FAILED_PRECONDITION if its classes or joints
// differ from the data's.
absl::Status CheckModelFits(const engine::ModelDescription& model, const dataset::Dataset& dataset);

// The synthesizer's input about the follower's first frame.
enum class StartGiven { kNone, kRoot, kPose };

// CheckModelFits, and FAILED_PRECONDITION for a start that the model does not accept.
absl::Status CheckModelTakes(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                             StartGiven start);

// The follower for a leader and any label vector ([classes]), as a server makes it: in blended
// windows. Errors: those
// of the network.
absl::StatusOr<motion::Poses> SynthesizeSequence(const engine::Synthesizer& synthesizer,
                                                 const dataset::Sequence& sequence,
                                                 const std::vector<float>& labels,
                                                 StartGiven start);

// The label vector of one class at weight 1. Shapes: returns [classes].
std::vector<float> OneClass(int classes, int interaction_class);

// A leader, the labels to answer it with, and the sampling of the answer.
struct LabelledLeader {
  const dataset::Sequence* sequence;
  engine::LabelTrack labels;
  engine::Sampling sampling = {};
  // False: the model estimates the partner's direction from the leader's motion, as for a request
  // without it.
  bool tell_direction = true;
  // Answered live, with so many frames of delay. Absent: with the whole leader known.
  std::optional<int> live_delay = std::nullopt;
};

// The same for many leaders, with several windows per evaluation of the network: much faster than
// one by one. Requires the same live_delay of all. Returns a follower for each, in order; fails if
// one fails.
absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    StartGiven start);

// Parameters of the requests to a model.
struct AskedSamples {
  int samples = 10;  // answers to each leader; a model that does not sample gives one
  float variety = 1;
  uint64_t seed = 0;  // of the whole set
  int candidates = engine::kDefaultCandidates;
  float reaction = 1;  // engine::Sampling::reaction
  bool tell_direction = true;
  std::optional<int> live_delay = std::nullopt;  // see LabelledLeader
};

// A request for one answer with these parameters. `seed`: of this answer.
LabelledLeader Ask(const dataset::Sequence& sequence, engine::LabelTrack labels,
                   const AskedSamples& asked, uint64_t seed);

// The seed of the n-th answer to a sequence. No two leaders share a seed: with common noise, their
// answers would vary less than in use.
uint64_t SeedOf(const AskedSamples& asked, const dataset::Dataset& dataset, int sequence, int n);

// The answers to sequences of the data set, each in its own class at weight 1. Errors: those of
// CheckModelTakes and of the network.
// Shapes: returns [samples][sequences].
absl::StatusOr<metrics::SampledMotions> AnswerWithSamples(const engine::Synthesizer& synthesizer,
                                                          const dataset::Dataset& dataset,
                                                          const std::vector<int>& sequences,
                                                          StartGiven start,
                                                          const AskedSamples& asked);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_ANSWERS_H_
