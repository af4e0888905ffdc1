#ifndef DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
#define DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"
#include "model/motion/poses.h"

namespace duet::evaluation::baselines {

// The two trivial rows, then the rows of Table 1 that need no network, in the order of the table.
std::vector<std::string> BaselineNames();

// Trains a baseline with its published settings (docs/baselines.md) on the training sequences of a
// split, and answers the test sequences. It receives the leader, the class and the partner's
// direction of a sequence; "frozen_first_frame" also the follower's first pose. Source: paper
// section 4. Requires a name of BaselineNames. Shapes: returns [test], in the split's order.
// Errors: INVALID_ARGUMENT for a class without a training sequence; INTERNAL naming baseline and
// sequence if an answer is not finite.
absl::StatusOr<std::vector<metrics::ScoredMotion>> RunBaseline(const std::string& name,
                                                               const dataset::Dataset& dataset,
                                                               const dataset::Split& split);

// For each test sequence, returns the captured follower of a random training sequence with the same
// class (`seed`), placed as it stood to its own leader in the first frame. Drawn among clips that
// are at least as long as the leader and cut to its length; if there are none, stretched. This is
// real motion of people who did not see the leader: its figures bound measures of similarity
// between different people. It is not synchronised with the leader.
//
// Shapes: returns [test]. Errors: INVALID_ARGUMENT for a class without a training sequence.
absl::StatusOr<std::vector<metrics::ScoredMotion>> AnswerWithOtherPeople(
    const dataset::Dataset& dataset, const dataset::Split& split, uint64_t seed);

// One row per frame (or sample), one column per value.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A captured pair in the coordinates of every baseline, those of the paper (metrics::StandardOf
// with the leader's root at the origin in every frame). Units: metres.
struct StandardPair {
  Rows leader;    // [frames, 3 joints]
  Rows cues;      // [frames, cues]: see StandardLeader
  Rows follower;  // [frames, 3 joints]
};

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

// Added to counts of events: unseen ones stay possible.
inline constexpr double kPseudoCount = 0.1;

// p(column | row) from counts.
Eigen::MatrixXd ConditionalProbabilities(const Eigen::MatrixXd& counts);

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

// A model of one interaction class: the follower of a leader (leader.follower is empty), both in
// the standard coordinates. Shapes: returns [frames, 3 joints].
using ClassModel = std::function<Rows(const StandardPair& leader)>;

// The baselines that learn a model of each class, with the published settings as constants.
// docs/baselines.md has their sources and implementations. `pairs` holds at least one sequence.
ClassModel LearnClassMean(const std::vector<StandardPair>& pairs);
ClassModel LearnNearestNeighbour(const std::vector<StandardPair>& pairs);
ClassModel LearnHmm(const std::vector<StandardPair>& pairs);
ClassModel LearnDiscreteMdp(const std::vector<StandardPair>& pairs);  // KZBH12
ClassModel LearnKernelRl(const std::vector<StandardPair>& pairs);     // HK14
ClassModel LearnMaxEntIoc(const std::vector<StandardPair>& pairs);    // HFKB15

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
