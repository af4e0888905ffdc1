#include <limits>

#include "model/evaluation/baselines/chain.h"
#include "model/evaluation/baselines/class_models.h"
#include "model/evaluation/baselines/motion_matrix.h"

namespace duet::evaluation::baselines {
namespace {

class ClassMean : public ClassModel {
 public:
  explicit ClassMean(const std::vector<StandardPair>& pairs) {
    // Each frame has the same weight, as in the metric.
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(pairs[0].follower.cols());
    double frames = 0;
    for (const StandardPair& pair : pairs) {
      sum += pair.follower.colwise().sum();
      frames += static_cast<double>(pair.follower.rows());
    }
    mean_ = sum / frames;
  }

  Rows Predict(const StandardPair& leader) const override {
    return mean_.replicate(leader.leader.rows(), 1);
  }

 private:
  Eigen::RowVectorXd mean_;
};

class NearestNeighbour : public ClassModel {
 public:
  explicit NearestNeighbour(const std::vector<StandardPair>& pairs) : pairs_(pairs) {}

  Rows Predict(const StandardPair& leader) const override {
    const StandardPair* nearest = nullptr;
    double best = std::numeric_limits<double>::infinity();
    for (const StandardPair& pair : pairs_) {
      const double distance = TimeWarpedDistance(leader.leader, pair.leader);
      if (nearest != nullptr && distance >= best) continue;
      best = distance;
      nearest = &pair;
    }
    return StretchTo(nearest->follower, leader.leader.rows());
  }

 private:
  std::vector<StandardPair> pairs_;
};

constexpr int kLeaderComponents = 4, kFollowerComponents = 8;

class Hmm : public ClassModel {
 public:
  explicit Hmm(const std::vector<StandardPair>& pairs)
      : leader_(StackCues(pairs), kLeaderComponents),
        follower_(StackFollowers(pairs), kFollowerComponents) {
    std::vector<Rows> sequences;
    for (const StandardPair& pair : pairs) {
      Rows both(pair.cues.rows(), leader_.dimensions() + follower_.dimensions());
      both << leader_.Project(pair.cues), follower_.Project(pair.follower);
      sequences.push_back(std::move(both));
    }
    hmm_ = GaussianHmm(sequences, {});
  }

  Rows Predict(const StandardPair& leader) const override {
    return follower_.Reconstruct(hmm_.ExpectRest(leader_.Project(leader.cues)));
  }

 private:
  PoseSpace leader_, follower_;
  GaussianHmm hmm_;
};

}  // namespace

std::unique_ptr<ClassModel> LearnClassMean(const std::vector<StandardPair>& pairs) {
  return std::make_unique<ClassMean>(pairs);
}

std::unique_ptr<ClassModel> LearnNearestNeighbour(const std::vector<StandardPair>& pairs) {
  return std::make_unique<NearestNeighbour>(pairs);
}

std::unique_ptr<ClassModel> LearnHmm(const std::vector<StandardPair>& pairs) {
  return std::make_unique<Hmm>(pairs);
}

}  // namespace duet::evaluation::baselines
