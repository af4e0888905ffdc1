#ifndef DUET_MODEL_EVALUATION_METRICS_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_SCORES_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

// Distances between a synthesised follower and the captured one.
//
// Shapes: predicted and truth are alike, of one frame or more, in world metres, y up. Differing
//         shapes are a programmer's error.
//
// In metres, every figure is invariant to a common translation and a common rotation about the
// vertical. In the raw unit, whose axes have different scales, it is invariant only to translation:
// pass motions in world coordinates, as captured, not levelled. The paper also rotates them, but
// after the scaling, which changes no norm.

namespace duet::evaluation::metrics {

// The unit that a displacement is measured in.
enum class MetricUnit {
  kMetres,
  // The unit of the paper's figures: SBU's normalised one, 1/2.56, 1/1.92 and 1/1.28 a metre along
  // x, y and z (Coordinates, kSbuNormalised).
  kSbuRaw
};

// Average frame distance: (1/T) sum_t | x^_t - x_t |, the Euclidean norm over all 3 J coordinates.
// Source: paper, Eq. 6.
double Afd(const motion::Poses& predicted, const motion::Poses& truth, MetricUnit unit);

// The same with the squared norm, as in the authors' released code. Square of the raw unit.
double AfdSquared(const motion::Poses& predicted, const motion::Poses& truth);

// Afd in the raw unit after each follower's own root joint is subtracted in every frame: the pose
// without the place.
double RootAlignedAfd(const motion::Poses& predicted, const motion::Poses& truth, int root);

// A follower for a sequence of the data set, synthesised or captured.
struct ScoredMotion {
  int sequence = 0;        // its index in the data set
  motion::Poses follower;  // world metres
};

inline const dataset::Sequence& SequenceOf(const dataset::Dataset& dataset,
                                           const ScoredMotion& motion) {
  return dataset.sequences[static_cast<size_t>(motion.sequence)];
}

// Every metric of one motion by its name. Names are lower_snake_case, with the unit unless the
// title of the table has it (report/metric_tables.cc). Metrics in SBU's raw unit are measured in
// the world as captured, before levelling.
std::map<std::string, double> ScoreMotion(const dataset::Dataset& dataset,
                                          const ScoredMotion& motion);

// Figures by the metric's name. Shapes: [classes] each.
using FiguresByMetric = std::map<std::string, std::vector<double>>;

// Every metric's means over the motions, at least one, of each class; NaN for a class without any.
// All motions have equal weight, except in penetration depth, which is a mean over the motions that
// penetrate.
FiguresByMetric ScoreByClass(const dataset::Dataset& dataset,
                             const std::vector<ScoredMotion>& motions);

// The classes of sequences of the data set.
std::vector<int> ClassesOf(const dataset::Dataset& dataset, const std::vector<int>& sequences);

// The captured followers of sequences of the data set, in the same order.
std::vector<ScoredMotion> CapturedMotions(const dataset::Dataset& dataset,
                                          const std::vector<int>& sequences);

// Figures of a model that gives many answers to one leader.
//
// The average frame distance rewards the mean of the possible answers: a sample from the true
// distribution has up to 1.41 times its distance. Therefore three distances are reported: of one
// answer, of the mean of all, and of the best of all. Source: ReGenNet (Xu et al. 2024) for
// multimodality.

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

#endif  // DUET_MODEL_EVALUATION_METRICS_SCORES_H_
