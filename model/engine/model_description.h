#ifndef DUET_MODEL_ENGINE_MODEL_DESCRIPTION_H_
#define DUET_MODEL_ENGINE_MODEL_DESCRIPTION_H_

#include <optional>
#include <string>
#include <vector>

#include "model/engine/direction_estimate.h"
#include "model/engine/leader_statistics.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// What a caller needs to know of a model: everything but its weights.
struct ModelDescription {
  std::string name;
  int version = 0;  // 1 or more
  std::string description;
  std::string terms;           // of use; empty: the checkpoint does not state them
  std::string weights_sha256;  // of the weights file, lower-case hex; empty: not from a checkpoint
  motion::Skeleton skeleton;
  std::vector<std::string> classes;  // interaction classes, in the order of the label vector
  // Those of the classes in which bodies touch as they like.
  std::vector<std::string> touching_classes;
  double frame_rate_hz = 0;  // the network's own
  int window_frames = 0;     // the longest window that the network was trained for
  bool accepts_follower_start = false;
  bool samples = false;  // answers depend on Sampling
  // Of the leaders that it was trained on, where that is known.
  std::optional<LeaderStatistics> leader_statistics;
  // Where the partner of a leader is expected when a caller does not tell. Absent: where the hips
  // face.
  std::optional<DirectionRegression> partner_direction;

  // Where nobody says: what models that sample answer is cleaned up (model/cleanup), a model with
  // one answer answers as it always did.
  bool cleaned_up_by_default() const { return samples; }

  int class_count() const { return static_cast<int>(classes.size()); }
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_MODEL_DESCRIPTION_H_
