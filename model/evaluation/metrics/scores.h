#ifndef DUET_MODEL_EVALUATION_METRICS_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_SCORES_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::metrics {

// Distances between a synthesised follower and the captured one.
//
// Shapes: predicted and truth are alike, of one frame or more, in one unit. Differing shapes are a
//         programmer's error.
//
// In metres, every figure is invariant to a common translation and a common rotation about the
// vertical. In the raw unit, whose axes have different scales, it is invariant only to translation:
// pass motions in world coordinates, as captured, not levelled. The paper also rotates them, but
// after the scaling, which changes no norm.

// Positions in the unit of the paper's figures: SBU's normalised one, 1/2.56, 1/1.92 and 1/1.28 a
// metre along x, y and z (Coordinates, kSbuNormalised).
motion::Poses ToRaw(motion::Poses metres);

// Average frame distance: (1/T) sum_t | x^_t - x_t |, the Euclidean norm over all 3 J coordinates.
// Source: paper, Eq. 6.
double Afd(const motion::Poses& predicted, const motion::Poses& truth);

// The same with the squared norm, as in the authors' released code.
double AfdSquared(const motion::Poses& predicted, const motion::Poses& truth);

// Without the place: each frame's root joint at the origin.
motion::Poses WithoutRoot(motion::Poses poses, int root);

// A follower for a sequence of the data set, synthesised or captured.
struct ScoredMotion {
  int sequence = 0;        // its index in the data set
  motion::Poses follower;  // world metres
};

inline const dataset::Sequence& SequenceOf(const dataset::Dataset& dataset,
                                           const ScoredMotion& motion) {
  return dataset.sequences[static_cast<size_t>(motion.sequence)];
}

// The coordinates of a sequence's leader: its root at the origin, -z towards the partner if the
// capture's setup has its direction, otherwise where the leader's hips face. The follower does not
// matter.
motion::Standardisation StandardOf(const motion::Skeleton& skeleton,
                                   const dataset::Sequence& sequence,
                                   motion::StandardOrigin origin);

// Every metric of one motion by its name. Names are lower_snake_case, with the unit unless the
// title of the table has it (report::MetricStyles). Metrics in SBU's raw unit are measured in
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

// Figures of what a classifier computes of motions: probabilities of classes, and features.

// Shapes: [samples][features].
using FeatureSet = std::vector<std::vector<float>>;

// Frechet distance of two Gaussians fitted to the sets (FID when the features are an extractor's):
// |mu1 - mu2|^2 + Tr(S1 + S2 - 2 (S1 S2)^(1/2)), covariances with divisor n - 1. Requires at least
// 2 samples on both sides.
//
// Source: Heusel et al. 2017; paper section 4. Tr (S1 S2)^(1/2) is computed as the sum of the
// singular values of A1^T A2 with S = A A^T (A: the centred samples over sqrt(n - 1)): their
// squares are the eigenvalues of S1 S2. No square root of a rank-deficient matrix is taken, so sets
// with fewer samples than features give exact values, never complex or negative ones.
double FrechetDistance(const FeatureSet& a, const FeatureSet& b);

// The mean Euclidean distance over all pairs of different samples. 0 for fewer than 2.
double Diversity(const FeatureSet& features);

// The share of samples whose nearest other sample (Euclidean) is of their class: how well the
// classes are separated in the space itself. NaN for fewer than 2 samples. Shapes: classes
// [samples].
double NeighbourAccuracy(const FeatureSet& features, const std::vector<int>& classes);

// Figures by class from the judges' results. Each fold has its own judge: features are comparable
// only within a fold.

// The results of a fold's judge for the fold's motions.
struct JudgedFold {
  std::vector<int> classes;                       // [motions], the requested classes
  std::vector<std::vector<float>> probabilities;  // [motions][classes]
  FeatureSet features;                            // [motions][features]
};

// The share of each class's motions, over all folds, whose likeliest class it is; NaN for a class
// without any. Shapes: returns [classes].
std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes);

// The Frechet distance between synthesised and captured motions of each class within a fold,
// averaged over the folds with at least 2 motions of it on both sides; NaN without such a fold.
// Shapes: made and captured [folds]; returns [classes].
std::vector<double> FrechetByClass(const std::vector<JudgedFold>& made,
                                   const std::vector<JudgedFold>& captured, int classes);

// The same of all classes together: a fold has too few motions of one class to estimate their
// spread.
double PooledFrechet(const std::vector<JudgedFold>& made, const std::vector<JudgedFold>& captured);

// The mean distance between motions of a class within a fold, averaged likewise.
std::vector<double> DiversityByClass(const std::vector<JudgedFold>& folds, int classes);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_SCORES_H_
