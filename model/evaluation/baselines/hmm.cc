#include "model/evaluation/baselines/class_models.h"
#include "model/evaluation/baselines/gaussian_hmm.h"
#include "model/evaluation/baselines/pose_space.h"

namespace duet::evaluation::baselines {
namespace {

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

std::unique_ptr<ClassModel> LearnHmm(const std::vector<StandardPair>& pairs) {
  return std::make_unique<Hmm>(pairs);
}

}  // namespace duet::evaluation::baselines
