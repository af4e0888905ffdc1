#ifndef DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_
#define DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::baselines {

// One row per frame (or sample), one column per value.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A captured pair in the coordinates of every baseline, those of the paper: the leader's root at
// the origin in every frame, one constant yaw; -z points towards the partner if the capture's setup
// has its direction, otherwise where the leader's hips face.
//
// Units: metres.
struct StandardPair {
  Rows leader;    // [frames, 3 joints]
  Rows cues;      // [frames, cues]: see StandardLeader
  Rows follower;  // [frames, 3 joints]
};

// The yaw depends only on the leader and the setup, never on the follower.
motion::Standardisation BaselineStandardisation(
    const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
    motion::StandardOrigin origin = motion::StandardOrigin::kEveryFrame);

// The leader's half of a pair; `follower` stays empty and sequence.pair.follower is not read. The
// cues are a method's input for the leader in each frame: the pose, its change over four frames,
// the root's movement since the first frame, and the time from 0 to 1 (the whole leader is known).
// Each is scaled so that typical changes have similar weights. Shapes: cues [frames, 6 joints + 4].
StandardPair StandardLeader(const motion::Skeleton& skeleton, const dataset::Sequence& sequence);
StandardPair StandardiseSequence(const motion::Skeleton& skeleton,
                                 const dataset::Sequence& sequence);

// Shapes: rows [frames, 3 joints].
Rows ToRows(const motion::Poses& poses);
motion::Poses FromRows(const Rows& rows);

// Resamples a motion linearly to another number of frames. Both numbers are at least 1.
Rows StretchTo(const Rows& motion, Eigen::Index frames);

// Squared distances between rows. Shapes: returns [a rows, b rows].
Eigen::MatrixXd SquaredDistances(const Rows& a, const Rows& b);

// The principal components of a set of rows.
class PoseSpace {
 public:
  PoseSpace() = default;
  // Fits at most `dimensions` components, fewer if the rows span fewer. Requires at least one row.
  PoseSpace(const Rows& rows, Eigen::Index dimensions);

  Eigen::Index dimensions() const { return basis_.cols(); }
  // Shapes: [n, values] to [n, dimensions] and back.
  Rows Project(const Rows& rows) const;
  Rows Reconstruct(const Rows& components) const;

 private:
  Eigen::RowVectorXd mean_;
  Eigen::MatrixXd basis_;  // [values, dimensions], orthonormal columns, strongest first
};

// Rows of several matrices with the same number of columns, one below the other. Requires at least
// one matrix.
Rows StackRows(const std::vector<Rows>& parts);

// One part of every pair, one below the other. Requires at least one pair.
Rows Stack(const std::vector<StandardPair>& pairs, Rows StandardPair::*part);

// Draws an index with a probability proportional to its weight. Weights are >= 0 and at least one
// is > 0.
inline Eigen::Index SampleIndex(const Eigen::Ref<const Eigen::VectorXd>& weights,
                                base::Random* random) {
  double left = random->Uniform() * weights.sum();
  Eigen::Index pick = 0;
  while (pick + 1 < weights.size() && left >= weights(pick)) left -= weights(pick++);
  return pick;
}

// Centres of clusters of rows: k-means++ seeding (Arthur, Vassilvitskii 2007), then Lloyd's
// iterations until nothing changes. At most `clusters` centres, fewer if there are fewer distinct
// rows. The same seed gives the same centres.
Rows KMeans(const Rows& rows, int clusters, uint64_t seed);

// The index of the centre nearest to each row.
std::vector<int> NearestCentres(const Rows& centres, const Rows& rows);

// Weights of the paths through a chain of states: a path s_0 .. s_{T-1} weighs
//   start(s_0) exp(arrival_0(s_0)) prod_t step(s_{t-1}, s_t) exp(arrival_t(s_t)).
// In a hidden Markov model start and step are probabilities and arrivals log densities of the
// observations. In maximum-entropy control they are exponentials of rewards, and the backward
// messages are exponentials of the soft value function
//   V_t(s) = log sum_s' exp(r(s, s') + arrival_{t+1}(s') + V_{t+1}(s')).
// The recurrences are the same.
struct ChainWeights {
  Eigen::RowVectorXd start;  // [states], >= 0
  Eigen::MatrixXd step;      // [from, to], >= 0
};

// The distribution over paths, proportional to their weights.
struct PathPosterior {
  Rows states;         // [frames, states]: probability of being there
  double log_sum = 0;  // log of the sum of all paths' weights (likelihood, partition function)
};

// Sums over all paths; never underflows. If `steps` is not null, adds the expected number of times
// that each step is taken. Shapes: log_arrivals [frames, states], steps [from, to].
// Source: Rabiner 1989; Ziebart et al. 2008.
PathPosterior SumOverPaths(const ChainWeights& chain, const Rows& log_arrivals,
                           Eigen::MatrixXd* steps = nullptr);

// A model of one interaction class, in the standard coordinates.
class ClassModel {
 public:
  virtual ~ClassModel() = default;
  // The follower of a leader (leader.follower is empty). Shapes: returns [frames, 3 joints].
  virtual Rows Predict(const StandardPair& leader) const = 0;
};

// The baselines that learn a model of each class, with the published settings as constants.
// docs/baselines.md has their sources and implementations. `pairs` holds at least one sequence.
std::unique_ptr<ClassModel> LearnClassMean(const std::vector<StandardPair>& pairs);
std::unique_ptr<ClassModel> LearnNearestNeighbour(const std::vector<StandardPair>& pairs);
std::unique_ptr<ClassModel> LearnHmm(const std::vector<StandardPair>& pairs);
// KZBH12: a discrete Markov decision process.
std::unique_ptr<ClassModel> LearnDiscreteMdp(const std::vector<StandardPair>& pairs);
// HK14: kernel-based reinforcement learning.
std::unique_ptr<ClassModel> LearnKernelRl(const std::vector<StandardPair>& pairs);
// HFKB15: approximate maximum-entropy inverse optimal control.
std::unique_ptr<ClassModel> LearnMaxEntIoc(const std::vector<StandardPair>& pairs);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_
