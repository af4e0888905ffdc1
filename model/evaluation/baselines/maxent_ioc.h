#ifndef DUET_MODEL_EVALUATION_BASELINES_MAXENT_IOC_H_
#define DUET_MODEL_EVALUATION_BASELINES_MAXENT_IOC_H_

#include <cstdint>
#include <random>
#include <vector>

#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet {

struct MaxEntIocOptions {
  int leader_components = 10;
  int pose_components = 8;
  double ridge = 20;          // of the regression from the leader's cues to the expected pose
  int actions = 24;           // displacements to choose from: clusters of those in training
  int value_samples = 150;    // poses that the value function is fitted on
  int value_centres = 32;     // radial functions of the value function
  int iterations = 15;        // of exponentiated gradient
  int demonstrations = 8;     // clips in each iteration
  int rollouts = 16;          // sampled paths for an expectation
  int answer_rollouts = 200;  // whose mean is the answer
  uint64_t seed = 1;
};

// Approximate maximum-entropy inverse optimal control over continuous poses: a reward linear in
// features, a soft value function fitted by regression (approximate dynamic programming), expected
// feature counts by Monte Carlo sampling of the policy.
//
// Source: row HFKB15 of the paper's Table 1: Huang, Farahmand, Kitani, Bagnell, Approximate MaxEnt
// Inverse Optimal Control and its Application for Mental Simulation of Human Interactions, AAAI
// 2015. Our reading: docs/baselines.md.
class MaxEntIoc : public PerClassMethod {
 public:
  explicit MaxEntIoc(const MaxEntIocOptions& options = {})
      : PerClassMethod("hfkb15"), options_(options) {}

 protected:
  void Reset(int classes) override { models_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  // Costs of stepping from a pose to the next under the leader's cues, all squared distances: next
  // to the pose expected from the cues; to the pose before; to the nearest cluster of training
  // poses.
  static constexpr int kFeatures = 3;
  using Weights = Eigen::Matrix<double, kFeatures, 1>;

  // Ridge regression from cues (with a constant) to poses.
  using Regression = Eigen::MatrixXd;

  struct Model {
    PoseSpace leader;
    PoseSpace follower;
    Regression regression;
    Rows centres;         // of training poses: value function and feature
    double width = 1;     // of the radial functions
    Rows actions;         // displacements
    Rows samples;         // poses that the value function is fitted on
    Rows arrivals;        // [samples x actions] poses after every action from every sample
    Rows arrival_basis;   // their value basis
    Eigen::MatrixXd fit;  // [basis, samples]: values at the samples to coefficients
    Weights weights;
  };
  // A training clip, with the poses that a regression without it expects.
  struct Demonstration {
    Rows expected;
    Rows poses;
  };

  static Regression FitRegression(const Rows& cues, const Rows& poses, double ridge);
  static Rows ApplyRegression(const Regression& regression, const Rows& cues);
  // 1, the components, and a radial function at each centre.
  static Rows Basis(const Model& model, const Rows& poses);
  // Features of arriving at each row of `next`. Shapes: returns [rows, features].
  static Eigen::Matrix<double, Eigen::Dynamic, kFeatures> Features(
      const Model& model, const Rows& next, const Rows& before, const Eigen::RowVectorXd& expected);
  void PrepareValues(const Rows& poses, Model* model) const;
  // Coefficients of the soft value function of each frame. Shapes: returns [frames, basis].
  static Rows SoftValues(const Model& model, const Rows& expected);
  // One path of the policy; adds up its features where wanted.
  static Rows Rollout(const Model& model, const Rows& expected, const Rows& values,
                      std::mt19937_64* random, Weights* features);
  void LearnReward(const std::vector<Demonstration>& demonstrations, Model* model) const;

  MaxEntIocOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet

#endif  // DUET_MODEL_EVALUATION_BASELINES_MAXENT_IOC_H_
