#ifndef DUET_MODEL_EVALUATION_BASELINES_MAXENT_IOC_H_
#define DUET_MODEL_EVALUATION_BASELINES_MAXENT_IOC_H_

#include <cstdint>
#include <vector>

#include "model/base/random.h"
#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet::evaluation::baselines {

struct MaxEntIocOptions {
  int leader_components = 10;
  int pose_components = 8;
  double ridge = 0.2;         // of the regression from the leader's cues to the expected pose
  int actions = 24;           // candidate displacements: clusters of those in training
  int value_samples = 150;    // poses on which the value function is fitted
  int value_centres = 32;     // radial functions of the value function
  int iterations = 15;        // exponentiated gradient steps
  int demonstrations = 8;     // clips in each iteration
  int rollouts = 16;          // sampled paths for an expectation
  int answer_rollouts = 200;  // paths whose mean is the answer
  uint64_t seed = 1;
};

// Approximate maximum-entropy inverse optimal control over continuous poses: a reward linear in
// features, a soft value function fitted by regression (approximate dynamic programming), expected
// feature counts by Monte Carlo sampling of the policy.
//
// Source: row HFKB15 of the paper's Table 1: Huang, Farahmand, Kitani, Bagnell, Approximate MaxEnt
// Inverse Optimal Control and its Application for Mental Simulation of Human Interactions, AAAI
// 2015. Implementation: docs/baselines.md.
class MaxEntIoc : public PerClassMethod {
 public:
  explicit MaxEntIoc(const MaxEntIocOptions& options = {})
      : PerClassMethod("hfkb15"), options_(options) {}

 protected:
  void Reset(int classes) override { models_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  // Costs of a step under the leader's cues, all squared lengths: from the next pose to the one
  // expected from the cues, to the previous pose, and to the mean pose of the class.
  static constexpr int kFeatures = 3;
  using Weights = Eigen::Matrix<double, kFeatures, 1>;
  using Costs = Eigen::Matrix<double, Eigen::Dynamic, kFeatures>;

  struct Model {
    PoseSpace leader;
    PoseSpace follower;
    Eigen::MatrixXd regression;  // from cues and a constant to poses
    Rows centres;                // clusters of training poses
    double width = 1;            // of the radial functions at the centres
    Rows actions;                // candidate displacements
    Eigen::VectorXd usual;       // [actions] log of the frequency in training
    Rows samples;                // poses on which the value function is fitted
    Rows arrivals;               // [samples x actions] the pose after each action from each sample
    Rows arrival_basis;          // their value basis
    Costs arrival_costs;         // their costs, except the first, which depends on the leader
    Eigen::MatrixXd fit;         // [basis, samples]: values at the samples to coefficients
    Weights weights;
  };
  // A training clip, with the poses that a regression fitted without it expects.
  struct Demonstration {
    Rows expected;
    Rows poses;
    Weights costs;  // of all its steps
  };
  // Sampled answers to one leader.
  struct Rollouts {
    Rows mean;                        // [frames, components]
    Weights costs = Weights::Zero();  // of all steps, the mean over paths
  };

  // The radial functions at the centres, normalised to a sum of one. Shapes: squared [n, centres].
  static Rows Basis(const Model& model, const Eigen::MatrixXd& squared);
  void PrepareActions(const Rows& changes, Model* model) const;
  void PrepareValues(const Rows& poses, Model* model) const;
  // Coefficients of the soft value function of each frame. Shapes: returns [frames, basis].
  static Rows SoftValues(const Model& model, const Rows& expected);
  // Samples `paths` answers from the policy of the soft value function.
  static Rollouts Sample(const Model& model, const Rows& expected, int paths, base::Random* random);
  static Demonstration Demonstrate(Rows expected, Rows poses);
  void LearnReward(const std::vector<Demonstration>& demonstrations, Model* model) const;

  MaxEntIocOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_MAXENT_IOC_H_
