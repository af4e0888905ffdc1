#ifndef DUET_MODEL_EVALUATION_BASELINES_DISCRETE_MDP_H_
#define DUET_MODEL_EVALUATION_BASELINES_DISCRETE_MDP_H_

#include <cstdint>
#include <vector>

#include "model/evaluation/baselines/chain.h"
#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet::evaluation::baselines {

struct DiscreteMdpOptions {
  int pose_states = 16;   // clusters of follower poses
  int leader_states = 8;  // clusters of leader cues
  int components = 10;    // principal components in which poses and cues are clustered
  int iterations = 30;    // gradient steps on the reward
  // The answer: the mean pose of each frame's states (true) or the most likely path's (false).
  bool expected_pose = true;
  uint64_t seed = 1;
};

// A discrete Markov decision process: states are clusters of follower poses, an action is the
// choice of the next one, the reward is linear in features of the step and of the leader's cluster,
// learnt by maximum-entropy inverse control with exact soft value iteration.
//
// Source: row KZBH12 of the paper's Table 1: Kitani, Ziebart, Bagnell, Hebert, Activity
// Forecasting, ECCV 2012, as used for interactions by Huang et al. Implementation:
// docs/baselines.md.
class DiscreteMdp : public PerClassMethod {
 public:
  explicit DiscreteMdp(const DiscreteMdpOptions& options = {})
      : PerClassMethod("kzbh12"), options_(options) {}

 protected:
  void Reset(int classes) override { models_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  // Features of arriving at a pose: (how well it matches the leader's cluster, how frequent the
  // step is, how little the pose changes).
  static constexpr int kFeatures = 3;
  using Weights = Eigen::Matrix<double, kFeatures, 1>;

  // A training sequence as cluster indices.
  struct Demonstration {
    std::vector<int> leader;
    std::vector<int> pose;
  };
  // How often clusters occur together.
  struct Counts {
    Eigen::MatrixXd together;  // [pose, leader]
    Eigen::MatrixXd steps;     // [from, to]
    Eigen::MatrixXd starts;    // [1, pose]
    Counts(Eigen::Index poses, Eigen::Index leaders);
    void Add(const Demonstration& one, double times);
  };
  // The features that follow from counts, as logs of smoothed conditional probabilities.
  struct Tables {
    Rows leader_given_pose;    // [leader, pose]
    Eigen::MatrixXd step;      // [from, to]
    Eigen::RowVectorXd start;  // [pose]
    Tables() = default;
    explicit Tables(const Counts& counts);
  };
  struct Model {
    PoseSpace leader;
    PoseSpace follower;
    Rows leader_centres;
    Rows pose_centres;  // in the follower's components
    Tables tables;
    Eigen::MatrixXd effort;  // [from, to] minus the squared change of pose
    Weights weights;
  };

  void LearnReward(const std::vector<Demonstration>& demonstrations, const Counts& counts,
                   Model* model) const;
  // Features of the demonstration minus the policy's expected features.
  static Weights Surplus(const Model& model, const Tables& tables, const Demonstration& one);
  static ChainWeights Chain(const Model& model, const Tables& tables);
  static Rows Arrivals(const Model& model, const Tables& tables, const std::vector<int>& leader);

  DiscreteMdpOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_DISCRETE_MDP_H_
