#include "model/engine/turn_history.h"

#include <algorithm>
#include <cstddef>

#include "model/engine/asked_turns.h"
#include "model/engine/turned_range.h"

namespace duet::engine {

TurnHistory::TurnHistory(const ModelDescription& model, const LabelTrack& labels,
                         double label_rate_hz, int frames) {
  if (model.turning_classes.empty() || !model.skeleton.hips) return;
  std::vector<float> weights(model.classes.size());
  for (int t = 0; t < frames; ++t) {
    labels.At(t * label_rate_hz / model.frame_rate_hz, weights.data());
    asks_.push_back(AsksForTurn(model, weights.data()));
  }
  turned_ = {0};
}

void TurnHistory::Add(const motion::Skeleton& skeleton, const motion::Poses& leader,
                      const motion::Poses& follower) {
  for (int t = 1; t < follower.frame_count(); ++t) {
    turned_.push_back(TurnedAt(*skeleton.hips, skeleton.root, follower, leader, t));
  }
}

TurnsAround TurnHistory::Around(int begin, int end) const {
  TurnsAround around;
  if (!is_used()) return around;
  const auto at = [](int frame) { return static_cast<std::ptrdiff_t>(frame); };
  int first = begin + 1;
  while (first > 0 && asks_[static_cast<std::size_t>(first - 1)]) --first;
  around.before.assign(turned_.begin() + at(first), turned_.begin() + at(begin + 1));
  const auto rest = asks_.begin() + at(end);
  if (asks_[static_cast<std::size_t>(end - 1)]) {
    around.after = static_cast<int>(std::find(rest, asks_.end(), false) - rest);
  }
  return around;
}

}  // namespace duet::engine
