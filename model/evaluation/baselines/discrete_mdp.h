#ifndef DUET_MODEL_EVALUATION_BASELINES_DISCRETE_MDP_H_
#define DUET_MODEL_EVALUATION_BASELINES_DISCRETE_MDP_H_

#include <cstdint>
#include <vector>

#include "model/evaluation/baselines/chain.h"
#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet {

struct DiscreteMdpOptions {
  int pose_states = 32;    // clusters of follower poses
  int leader_states = 16;  // clusters of leader cues
  int components = 10;     // that poses and cues are clustered in
  int iterations = 30;     // of the reward's ascent
  // The answer: the mean pose of each frame's states (true) or the most likely path's (false).
  bool expected_pose = true;
  uint64_t seed = 1;
};

// A discrete Markov decision process: states are clusters of follower poses, an action is the
// choice of the next one, the reward is linear in features of the step and of the leader's cluster,
// learnt by maximum-entropy inverse control with exact soft value iteration.
//
// Source: row KZBH12 of the paper's Table 1: Kitani, Ziebart, Bagnell, Hebert, Activity
// Forecasting, ECCV 2012, as used for interactions by Huang et al. Our reading: docs/baselines.md.
class DiscreteMdp : public PerClassMethod {
 public:
  explicit DiscreteMdp(const DiscreteMdpOptions& options = {})
      : PerClassMethod("kzbh12"), options_(options) {}

 protected:
  void Reset(int classes) override { models_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  // Features of arriving at a pose: (how well it goes with the leader's cluster, how usual the step
  // is, how little the pose changes).
  static constexpr int kFeatures = 3;
  using Weights = Eigen::Matrix<double, kFeatures, 1>;

  struct Model {
    PoseSpace leader;
    PoseSpace follower;
    Rows leader_centres;
    Rows pose_centres;           // in the follower's components
    Rows log_leader_given_pose;  // [leader states, pose states]
    Eigen::RowVectorXd log_start;
    Eigen::MatrixXd log_step;  // [from, to]
    Eigen::MatrixXd effort;    // [from, to] minus the squared change of pose
    Weights weights;
  };
  // A training sequence in clusters.
  struct Demonstration {
    std::vector<int> leader;
    std::vector<int> pose;
  };

  void CountStatistics(const std::vector<Demonstration>& demonstrations, Model* model) const;
  void LearnReward(const std::vector<Demonstration>& demonstrations, Model* model) const;
  static ChainWeights Chain(const Model& model);
  static Rows Arrivals(const Model& model, const std::vector<int>& leader);

  DiscreteMdpOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet

#endif  // DUET_MODEL_EVALUATION_BASELINES_DISCRETE_MDP_H_
