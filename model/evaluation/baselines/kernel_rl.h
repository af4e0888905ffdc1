#ifndef DUET_MODEL_EVALUATION_BASELINES_KERNEL_RL_H_
#define DUET_MODEL_EVALUATION_BASELINES_KERNEL_RL_H_

#include <vector>

#include "model/evaluation/baselines/chain.h"
#include "model/evaluation/baselines/per_class_method.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet::evaluation::baselines {

struct KernelRlOptions {
  int components = 10;
  // Training frames kept: of more, every second (third, ...) one, and the leader's likewise.
  int most_samples = 400;
  // Widths of the kernels, in units of the median distance to the nearest sample of another clip.
  double transition_width = 1.0;
  double decoding_width = 4.0;
  double velocity_weight = 2.0;  // of the change over a step, beside the pose
  int demonstrations = 8;        // clips that the reward's weight is learnt from
};

// Kernel-based reinforcement learning: the value function lives on the training samples, and what
// follows a pose is what followed similar ones, weighted by a kernel. The reward prefers samples
// whose leader is like the given one; its weight is the one under which the demonstrations are most
// likely. Mean shift turns each frame's weighted samples into one pose.
//
// Source: row HK14 of the paper's Table 1: Huang, Kitani, Action-Reaction: Forecasting the Dynamics
// of Human Interaction, ECCV 2014; Ormoneit, Sen 2002. Our reading: docs/baselines.md.
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
    std::vector<int> clip;    // which sequence a sample is from
    Eigen::MatrixXd step;     // [from, to]: what follows samples like `from`
    double pose_width = 1;    // median distance to the nearest sample of another clip
    double reward_weight = 1;
  };

  void BuildStep(const std::vector<int>& successor, Model* model) const;
  void LearnReward(const std::vector<StandardPair>& pairs, Model* model) const;
  double LogLikelihood(const Model& model, const std::vector<StandardPair>& pairs,
                       double weight) const;
  // How unlike each sample's the leader's cues are. Shapes: returns [frames / stride, samples].
  static Rows Cost(const Model& model, const Rows& cues);
  // Soft value iteration and the policy's visits, given what arriving at each sample costs in each
  // frame. Samples of the clip `without` count as absent (-1: none).
  static PathPosterior Plan(const Model& model, const Rows& cost, int without);
  Rows MeanShift(const Model& model, const Rows& visits) const;

  KernelRlOptions options_;
  std::vector<Model> models_;
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_KERNEL_RL_H_
