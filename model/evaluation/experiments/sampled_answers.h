#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SAMPLED_ANSWERS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SAMPLED_ANSWERS_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/experiments/synthesizer_method.h"
#include "model/evaluation/metrics/sampled_scores.h"

namespace duet::evaluation::experiments {

// Parameters of the requests to a model.
struct AskedSamples {
  int samples = 10;  // answers to each leader; a model that does not sample gives one
  float variety = 1;
  uint64_t seed = 0;  // of the whole set
  int candidates = engine::kDefaultCandidates;
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

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SAMPLED_ANSWERS_H_
