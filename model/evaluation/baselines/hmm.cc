#include "model/evaluation/baselines/hmm.h"

namespace duet::evaluation::baselines {

void Hmm::TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) {
  Model& model = models_[static_cast<size_t>(interaction_class)];
  model.leader =
      PoseSpace(StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.cues; }),
                options_.leader_components);
  model.follower =
      PoseSpace(StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.follower; }),
                options_.follower_components);
  std::vector<Rows> sequences;
  for (const StandardPair& pair : pairs) {
    Rows both(pair.cues.rows(), model.leader.dimensions() + model.follower.dimensions());
    both << model.leader.Project(pair.cues), model.follower.Project(pair.follower);
    sequences.push_back(std::move(both));
  }
  model.hmm = GaussianHmm(sequences, options_.hmm);
}

Rows Hmm::PredictClass(int interaction_class, const StandardPair& leader) const {
  const Model& model = models_[static_cast<size_t>(interaction_class)];
  return model.follower.Reconstruct(model.hmm.ExpectRest(model.leader.Project(leader.cues)));
}

}  // namespace duet::evaluation::baselines
