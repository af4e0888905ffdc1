#ifndef DUET_MODEL_TRAINING_AUGMENT_H_
#define DUET_MODEL_TRAINING_AUGMENT_H_

#include <vector>

#include "absl/status/status.h"
#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/engine/model_description.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/training/options.h"

namespace duet::training {

// For each joint, its counterpart in a mirror: left and right exchanged by name.
std::vector<int> MirroredJoints(const motion::Skeleton& skeleton);

// Reflects a person in the plane x = 0 and exchanges its left and right joints.
void Mirror(const std::vector<int>& mirrored_joints, motion::Poses* poses);

// Reflects both people in the plane x = 0 and exchanges their left and right joints.
void Mirror(const std::vector<int>& mirrored_joints, dataset::Sequence* sequence);

// Exchanges leader and follower.
void SwapRoles(dataset::Sequence* sequence);

// A random vector whose components have this standard deviation.
motion::Vec3 Normal3(double deviation, base::Random* random);

// Adds the noise of a captured leader: `noise` and `body_noise` of the options.
void DisturbLeader(const CommonSettings::Augmentation& options, base::Random* random,
                   motion::Clip* leader);

// A random variant of a sequence. Requires options that CheckAgainst accepts.
dataset::Sequence Augment(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
                          const CommonSettings::Augmentation& options, base::Random* random);

// Checks that the skeleton has the joints that AddStillness needs, if the options use it.
// INVALID_ARGUMENT otherwise.
absl::Status CheckStillness(const TrainingOptions& options, const dataset::Dataset& dataset);

// A clip with what is around a captured reaction.
struct StillClip {
  dataset::Sequence sequence;
  // The follower does not begin at its place: the clip needs a start pose.
  bool amid = false;
  // Nothing is asked of the follower, which therefore rests: the clip needs weights of 0.
  bool unlabelled = false;
};

// Adds to a captured clip what its cut left out. Captures begin and end with the action, so they
// never show that a follower rests while nothing happens, and comes back to rest afterwards. Draws
// one of:
//
// - a reaction with pauses before and after it. Before, both people hold their first poses. After,
//   the leader holds still, or slows down, or goes to rest; the follower slows down, and then goes
//   to rest;
// - the end of a reaction and a longer rest;
// - a leader who does not move. The follower rests, or goes to rest from a pose of the reaction;
// - the captured leader and a follower that rests, unlabelled: without a class, nothing is asked.
//
// A person at rest has the calmest pose of the clip (hands low, feet together) at the place of its
// first frame, relative to the leader, and shifts its weight. It gets there in one step of each
// foot; feet stand otherwise.
//
// The clip is at most `most_frames` long; a reaction that leaves no room gets no pauses. Requires
// the joints of CheckStillness, and a clip without a time line of labels. Units: frame_rate_hz of
// the clip.
StillClip AddStillness(const motion::Skeleton& skeleton, const FlowSettings::Stillness& options,
                       double frame_rate_hz, int most_frames, base::Random* random,
                       dataset::Sequence sequence);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_AUGMENT_H_
