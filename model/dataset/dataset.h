#ifndef DUET_MODEL_DATASET_DATASET_H_
#define DUET_MODEL_DATASET_DATASET_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/clip.h"
#include "model/motion/levelling.h"
#include "model/motion/skeleton.h"

namespace duet::dataset {

// Two people captured together, sorted into leader and follower.
struct Sequence {
  std::string id;                     // path below the data set's folder
  int interaction_class = 0;          // index into Dataset::classes
  std::string set;                    // captured by one camera in one place; may be empty
  std::vector<std::string> subjects;  // people in it, when the data set says
  // "index": the data set's index; "guess": a guess by its own word; "motion": the motion rule.
  std::string leader_source;
  // Whether the motion rule names the same leader; nothing for a class that it knows no effectors
  // of.
  std::optional<bool> rule_agrees;
  motion::ClipPair pair;        // world metres, y up, joints in the skeleton's order
  motion::Levelling levelling;  // from the world as captured to that of `pair`
  // Horizontal direction from leader to follower, where the capture's setup tells it: SBU and K3HI
  // stand their people along the image's x axis. Which of them stands where is one bit, taken from
  // the first frame; nothing else of the follower's motion goes into it.
  std::optional<motion::Vec3> partner_direction;
};

struct Dataset {
  std::string name;
  motion::Skeleton skeleton;
  std::vector<motion::BodyPart> parts;  // of the skeleton, for a network
  std::vector<std::string> classes;
  // For each class: true where either person may lead, so that the two may be exchanged.
  std::vector<bool> symmetric;
  // For each class: true where custom says which hand does it, so that its mirror image is not
  // what people do.
  std::vector<bool> handed;
  // For each class: true where bodies touch as they like.
  std::vector<bool> touches;
  double frame_rate_hz = 0;
  std::vector<Sequence> sequences;  // sorted by id
  // What dataset.json left out and was found, for people to read.
  std::vector<std::string> notes;

  int class_count() const { return static_cast<int>(classes.size()); }
  std::vector<std::string> TouchingClasses() const;
  // Every subject, sorted.
  std::vector<std::string> Subjects() const;
  // Frames of the longest sequence.
  int LongestFrameCount() const;
};

// Reads a folder of captures. The layout is recognised:
//
//   SBU       sXXsYY/<class>/<sequence>/skeleton_pos.txt; classes 03 to 08 as kick, push,
//             shake_hands, hug, exchange_object, punch; 15 frames a second
//   K3HI      <class>/<sequence>.txt, 8 classes, 30 frames a second
//   own data  dataset.json beside <class>/<sequence>.txt (docs/datasets.md)
//
// SBU, K3HI and own data that asks for it are levelled (levelling.h), set by set: a set is an SBU
// folder sXXsYY, or else the whole data set.
//
// The leader's side comes from index.tsv where it names one, else from the motion rule: the leader
// is whose effector (feet for kicks, hands otherwise) has the larger peak displacement relative to
// the own torso.
//
// Errors: NOT_FOUND for a folder that is no data set, INVALID_ARGUMENT naming file and line.
absl::StatusOr<Dataset> ReadDataset(const std::filesystem::path& folder);

// Indices into Dataset::sequences.
struct Split {
  std::vector<int> train;
  std::vector<int> test;
};

// Leave one subject out: test on every sequence with the subject in either place, train on the
// rest.
// Errors: NOT_FOUND for a subject that the data set does not have.
absl::StatusOr<Split> LeaveSubjectOut(const Dataset& dataset, const std::string& subject);

// Half of each class to train on and the other half to test on, chosen by `seed` alone; of an odd
// number the larger part is trained on. Both sorted. A subject may be in both.
// Errors: INVALID_ARGUMENT naming a class of fewer than 2 sequences.
absl::StatusOr<Split> SplitInHalves(const Dataset& dataset, uint64_t seed);

// Moves about `fraction` (0 to below 1) of each class from train to a validation set, chosen by
// `seed` alone; at least one of each class and never the last of a class. Both come out sorted.
// Test sequences play no part in it.
std::vector<int> TakeValidation(const Dataset& dataset, double fraction, uint64_t seed,
                                std::vector<int>* train);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_DATASET_H_
