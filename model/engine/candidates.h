#ifndef DUET_MODEL_ENGINE_CANDIDATES_H_
#define DUET_MODEL_ENGINE_CANDIDATES_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "model/body/limbs.h"
#include "model/engine/critic.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/solver/partner.h"

// Several samples of one window, of which the best is returned. World metres, y up.
namespace duet::engine {

// Number of samples that a model draws for each window: 1 if it does not sample.
int CandidateCount(const ModelDescription& model, const Sampling& sampling);

// What a window costs, in evaluations of its leader: one for each candidate, twice as many with
// guidance by the leader (Sampling::reaction).
int EvaluationCount(const ModelDescription& model, const Sampling& sampling);

// The seed of a window's n-th candidate; that of the first is `seed`, so that one candidate is the
// answer without candidates.
uint64_t CandidateSeed(uint64_t seed, int n);

// Chooses among the samples of a window by what a viewer would notice (model/body/grade.h), by how
// far hands that meet are apart, by how far the samples are from the window's pins, and by how much
// a critic takes them for captured.
//
// Cost:    linear in the frames and in the candidates.
// Threads: const methods are safe to call concurrently.
class CandidateJudge {
 public:
  // Requires a skeleton that Validate accepts. A skeleton without the joints of a measure is judged
  // by the others.
  explicit CandidateJudge(const motion::Skeleton& skeleton,
                          std::optional<Critic> critic = std::nullopt);

  // The index of the best follower; the first of several. `settled`: first frames that all have in
  // common. `pins`: of the window, which the followers do not honour yet. `rules`: where hands are
  // to meet; may be empty. `labels`: what the critic sees of the labels. Shapes: every follower is
  // like the leader; rules [frames]; labels [frames, classes]. Requires at least one.
  int Best(const motion::Poses& leader, const std::vector<motion::Poses>& followers, int settled,
           double frame_rate_hz, const motion::Pins& pins = {},
           const solver::ContactRules& rules = {}, absl::Span<const float> labels = {}) const;

 private:
  // How far hands that are to meet are apart, mean over the frames after the settled ones, metres.
  double HandsApart(const motion::Poses& leader, const motion::Poses& follower, int settled,
                    const solver::ContactRules& rules) const;
  double Faults(const motion::Poses& leader, const motion::Poses& follower, int settled,
                double frame_rate_hz) const;

  motion::Skeleton skeleton_;
  body::Body body_;
  std::optional<Critic> critic_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CANDIDATES_H_
