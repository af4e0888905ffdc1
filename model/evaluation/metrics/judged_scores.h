#ifndef DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_

#include <vector>

// Figures of what a classifier computes of motions: probabilities of classes, and features.

namespace duet::evaluation::metrics {

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

// The share of each class's motions whose likeliest class it is; NaN for a class without any.
// Shapes: meant [motions], probabilities [motions][classes]; returns [classes].
std::vector<double> ClassAccuracies(const std::vector<int>& meant,
                                    const std::vector<std::vector<float>>& probabilities,
                                    int classes);

// Figures by class from the judges' results. Each fold has its own judge: features are comparable
// only within a fold.

// The results of a fold's judge for the fold's motions.
struct JudgedFold {
  std::vector<int> classes;                       // [motions], the requested classes
  std::vector<std::vector<float>> probabilities;  // [motions][classes]
  FeatureSet features;                            // [motions][features]
};

// ClassAccuracies over all folds. Shapes: returns [classes].
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

#endif  // DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
