#ifndef DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_
#define DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_

#include <memory>
#include <vector>

#include "model/evaluation/baselines/per_class_method.h"

// The baselines that learn a model of each class, one .cc file each, with the published settings as
// constants. Implementation: docs/baselines.md. `pairs` holds at least one sequence.

namespace duet::evaluation::baselines {

// The trivial method: the mean follower pose, held still in the standard coordinates.
std::unique_ptr<ClassModel> LearnClassMean(const std::vector<StandardPair>& pairs);

// Answers with the follower of the most similar leader (time-warped distance over the whole clip),
// stretched to the leader's length.
// Source: row NN of the paper's Table 1, taken there from Huang et al. 2015.
std::unique_ptr<ClassModel> LearnNearestNeighbour(const std::vector<StandardPair>& pairs);

// A hidden Markov model over leader and follower together; the answer is the expected follower
// given the whole leader.
// Source: row HMM of the paper's Table 1.
std::unique_ptr<ClassModel> LearnHmm(const std::vector<StandardPair>& pairs);

// A discrete Markov decision process: states are clusters of follower poses, an action is the
// choice of the next one, the reward is linear in features of the step and of the leader's cluster,
// learnt by maximum-entropy inverse control with exact soft value iteration.
// Source: row KZBH12 of the paper's Table 1: Kitani, Ziebart, Bagnell, Hebert, Activity
// Forecasting, ECCV 2012, as used for interactions by Huang et al.
std::unique_ptr<ClassModel> LearnDiscreteMdp(const std::vector<StandardPair>& pairs);

// Kernel-based reinforcement learning: the value function is defined on the training samples, and
// transitions from a pose are those of similar poses, weighted by a kernel. The reward prefers
// samples whose leader resembles the given one; its weight maximises the likelihood of the
// demonstrations. Mean shift turns each frame's weighted samples into one pose.
// Source: row HK14 of the paper's Table 1: Huang, Kitani, Action-Reaction: Forecasting the Dynamics
// of Human Interaction, ECCV 2014; Ormoneit, Sen 2002.
std::unique_ptr<ClassModel> LearnKernelRl(const std::vector<StandardPair>& pairs);

// Approximate maximum-entropy inverse optimal control over continuous poses: a reward linear in
// features, a soft value function fitted by regression (approximate dynamic programming), expected
// feature counts by Monte Carlo sampling of the policy.
// Source: row HFKB15 of the paper's Table 1: Huang, Farahmand, Kitani, Bagnell, Approximate MaxEnt
// Inverse Optimal Control and its Application for Mental Simulation of Human Interactions, AAAI
// 2015.
std::unique_ptr<ClassModel> LearnMaxEntIoc(const std::vector<StandardPair>& pairs);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_CLASS_MODELS_H_
