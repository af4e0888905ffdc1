#ifndef DUET_MODEL_ENGINE_MODEL_DESCRIPTION_H_
#define DUET_MODEL_ENGINE_MODEL_DESCRIPTION_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/engine/direction_estimate.h"
#include "model/engine/leader_statistics.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// A class in which people meet with their hands, and the distance of the hands when they do.
struct HandContact {
  std::string interaction_class;
  double metres = 0;
};

// A class in which a hand of the follower rests on the leader's trunk, and where, in lengths of the
// trunk (solver::TrunkAxes).
struct TrunkContact {
  std::string interaction_class;
  std::string hand;  // a joint
  motion::Vec3 place;
};

// A class in which the follower faces its leader, and how far it is turned away at most.
struct FacingClass {
  std::string interaction_class;
  double degrees = 0;
};

inline constexpr int kMostDefaultSeeds = 1024;

// Everything that callers need to know about a model, without its weights.
struct ModelDescription {
  std::string name;
  int version = 0;  // 1 or more
  std::string description;
  std::string terms;  // of use; empty: not specified by the checkpoint
  // Anybody may use and pass on the weights and their output for any purpose.
  bool free_for_all_uses = false;
  std::string weights_sha256;  // of the weights file, lower-case hex; empty: not from a checkpoint
  motion::Skeleton skeleton;
  std::vector<std::string> classes;  // interaction classes, in the order of the label vector
  // The classes in which the bodies may overlap, such as an embrace.
  std::vector<std::string> touching_classes;
  // The classes in which a hand that the leader offers is met.
  std::vector<HandContact> hand_contacts;
  // The classes and hands that rest on the leader's trunk.
  std::vector<TrunkContact> trunk_contacts;
  // The classes in which a follower that is turned away is turned back to its leader.
  std::vector<FacingClass> facing_classes;
  // The follower's limb lengths as multiples of the leader's, unless its pose is known. Empty: the
  // leader's lengths. Shapes: [bones].
  std::vector<double> bone_ratios;
  double frame_rate_hz = 0;  // the network's own
  int window_frames = 0;     // maximum window length that the network was trained on
  // The last frames of a window that the next window replaces, because their leader's future was
  // unknown. Only for models that sample. Less than the part of a window that is not settled.
  int lookahead_frames = 0;
  bool accepts_follower_start = false;
  bool samples = false;  // results depend on Sampling
  // Labels are guidance: the network answers each class by itself, and answers are combined
  // (mixture.h). Otherwise the network reads the label vector.
  bool labels_guide = false;
  // The seeds that a server draws from for callers who name none, at most kMostDefaultSeeds. Empty:
  // any.
  std::vector<uint64_t> default_seeds;
  // Statistics of the training leaders. Absent if unknown.
  std::optional<LeaderStatistics> leader_statistics;
  // Estimates the partner's direction if the caller specifies none. Absent: the direction in which
  // the leader's hips face.
  std::optional<DirectionRegression> partner_direction;

  // Whether the synthesizer cleans up at all unless a caller asks for it (MakeSynthesizer).
  bool clean_up = true;

  // The default of SynthesisOptions::clean_up. True for models that sample.
  bool cleaned_up_by_default() const { return samples && clean_up; }

  int class_count() const { return static_cast<int>(classes.size()); }

  // Whether the class is one of contact: bodies touch, or hands meet.
  bool IsContact(int label) const {
    const std::string& label_name = classes[static_cast<std::size_t>(label)];
    return std::count(touching_classes.begin(), touching_classes.end(), label_name) > 0 ||
           std::any_of(hand_contacts.begin(), hand_contacts.end(), [&](const HandContact& hands) {
             return hands.interaction_class == label_name;
           });
  }
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_MODEL_DESCRIPTION_H_
