#ifndef DUET_MODEL_EVALUATION_METRICS_SAMPLED_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_SAMPLED_SCORES_H_

#include <vector>

#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"

// Figures of a model that gives many answers to one leader.
//
// The average frame distance rewards the mean of the possible answers: a sample from the true
// distribution has up to 1.41 times its distance. Therefore three distances are reported: of one
// answer, of the mean of all, and of the best of all. Source: ReGenNet (Xu et al. 2024) for
// multimodality.

namespace duet::evaluation::metrics {

// Shapes: [samples][motions]; every set answers the same sequences in the same order.
using SampledMotions = std::vector<std::vector<ScoredMotion>>;

// Every set's motions, one after the other.
std::vector<ScoredMotion> Pool(const SampledMotions& samples);

// For each sequence, the answers' mean, joint by joint and frame by frame.
std::vector<ScoredMotion> MeanAnswers(const SampledMotions& samples);

// For each sequence, its answer with the smallest afd. Finding it needs the captured follower.
std::vector<ScoredMotion> BestAnswers(const dataset::Dataset& dataset,
                                      const SampledMotions& samples);

// Multimodality: the mean afd (SBU's raw unit) between any two answers to a leader, averaged over
// the leaders of each class. 0 for one answer each; NaN for a class without leaders.
// Shapes: returns [classes].
std::vector<double> MultimodalityByClass(const dataset::Dataset& dataset,
                                         const SampledMotions& samples);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_SAMPLED_SCORES_H_
