#ifndef DUET_MODEL_EVALUATION_BASELINES_KERNEL_RL_H_
#define DUET_MODEL_EVALUATION_BASELINES_KERNEL_RL_H_

#include <vector>

#include "model/evaluation/baselines/chain.h"
#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet::evaluation::baselines {

struct KernelRlOptions {
  int components = 10;
  // The most training frames to keep: of more, every second (third, ...) one, and the leader's
  // likewise.
  int most_samples = 400;
  // Widths of the kernels, in units of the median distance to the nearest sample of another clip.
  double transition_width = 1.0;
  double decoding_width = 4.0;
  double velocity_weight = 2.0;  // weight of the change over a step, relative to the pose
  int demonstrations = 8;        // clips from which the reward's weight is learnt
};

// Kernel-based reinforcement learning: the value function is defined on the training samples, and
// transitions from a pose are those of similar poses, weighted by a kernel. The reward prefers
// samples whose leader resembles the given one; its weight maximises the likelihood of the
// demonstrations. Mean shift turns each frame's weighted samples into one pose.
//
// Source: row HK14 of the paper's Table 1: Huang, Kitani, Action-Reaction: Forecasting the Dynamics
// of Human Interaction, ECCV 2014; Ormoneit, Sen 2002. Implementation: docs/baselines.md.
class KernelRl : public PerClassMethod {
 public:
  explicit KernelRl(const KernelRlOptions& options = {})
      : PerClassMethod("hk14"), options_(options) {}

 protected:
  void Reset(int classes) override { models_.assign(static_cast<size_t>(classes), {}); }
  void TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) override;
  Rows PredictClass(int interaction_class, const StandardPair& leader) const override;

 private:
  struct Model {
    PoseSpace leader;
    PoseSpace follower;
    Eigen::Index stride = 1;  // frames from one sample to the next
    Rows cues;                // [samples, components]
    Rows poses;               // [samples, components]
    std::vector<int> clip;    // the sequence of each sample
    Eigen::MatrixXd step;     // [from, to]: transitions from samples similar to `from`
    double pose_width = 1;    // median distance to the nearest sample of another clip
    double reward_weight = 1;
  };

  void BuildStep(const std::vector<int>& successor, Model* model) const;
  void LearnReward(const std::vector<StandardPair>& pairs, Model* model) const;
  double LogLikelihood(const Model& model, const std::vector<StandardPair>& pairs,
                       double weight) const;
  // Distances between the leader's cues and each sample's. Shapes: returns [frames / stride,
  // samples].
  static Rows Cost(const Model& model, const Rows& cues);
  // Soft value iteration and the policy's visits, given the cost of arriving at each sample in each
  // frame. Ignores samples of the clip `without` (-1: none).
  static PathPosterior Plan(const Model& model, const Rows& cost, int without);
  Rows MeanShift(const Model& model, const Rows& visits) const;

  KernelRlOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_KERNEL_RL_H_
