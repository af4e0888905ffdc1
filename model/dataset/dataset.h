#ifndef DUET_MODEL_DATASET_DATASET_H_
#define DUET_MODEL_DATASET_DATASET_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/body_part.h"
#include "model/motion/clip.h"
#include "model/motion/levelling.h"
#include "model/motion/skeleton.h"

namespace duet::dataset {

// A class that a sequence shows from frame `begin` up to frame `end`, exclusive.
struct LabelSpan {
  int interaction_class = 0;  // index into Dataset::classes
  int begin = 0;
  int end = 0;
};

// Two people captured together, assigned to leader and follower.
struct Sequence {
  std::string id;                     // path below the data set's folder
  int interaction_class = 0;          // index into Dataset::classes; of several, the longest
  std::vector<LabelSpan> labels;      // on a time line; empty: one class throughout
  std::string set;                    // captured by one camera in one place; may be empty
  std::vector<std::string> subjects;  // people in it, if the data set states them
  // "index": the data set's index; "guess": a guess by its own word; "motion": the motion rule.
  std::string leader_source;
  motion::ClipPair pair;        // world metres, y up, joints in the skeleton's order
  motion::Levelling levelling;  // from the world as captured to that of `pair`
  // Horizontal direction from leader to follower, if the capture's setup defines it: in SBU and
  // K3HI people stand along the image's x axis. The sign comes from the first frame; nothing else
  // of the follower's motion is used.
  std::optional<motion::Vec3> partner_direction;
};

struct Dataset {
  std::string name;
  motion::Skeleton skeleton;
  std::vector<motion::BodyPart> parts;  // of the skeleton, for a network
  std::vector<std::string> classes;
  // For each class, whether either person may lead, so that the two may be exchanged.
  std::vector<bool> symmetric;
  // For each class, whether custom determines the hand, so that its mirror image does not occur.
  std::vector<bool> handed;
  // For each class, whether bodies may touch.
  std::vector<bool> touches;
  double frame_rate_hz = 0;
  std::vector<Sequence> sequences;  // sorted by id
  // The values inferred because dataset.json omits them, for people to read.
  std::vector<std::string> notes;

  int class_count() const { return static_cast<int>(classes.size()); }
  std::vector<std::string> TouchingClasses() const;
  // Every subject, sorted.
  std::vector<std::string> Subjects() const;
  // Frames of the longest sequence.
  int LongestFrameCount() const;
};

// Reads a folder of captures. Recognises the layout:
//
//   SBU       sXXsYY/<class>/<sequence>/skeleton_pos.txt; classes 03 to 08 as kick, push,
//             shake_hands, hug, exchange_object, punch; 15 frames per second
//   K3HI      <class>/<sequence>.txt, 8 classes, 30 frames per second
//   own data  dataset.json beside <class>/<sequence>.txt, or beside labels.tsv and the files that
//             it names (docs/datasets.md)
//
// Levels SBU, K3HI, and your own data if its dataset.json requests it (LevelSets), set by set: a
// set is an SBU folder sXXsYY, or otherwise the whole data set.
//
// The leader's side comes from index.tsv if it states one, otherwise from the motion rule: the
// leader is the person whose effector (feet for kicks, hands otherwise) has the larger peak
// displacement relative to the person's own torso.
//
// Errors: NOT_FOUND if the folder is not a data set; INVALID_ARGUMENT naming file and line.
absl::StatusOr<Dataset> ReadDataset(const std::filesystem::path& folder);

// Levels captures of a tilted camera, in which people lean. All sequences of a set (Sequence::set)
// share one motion::Levelling, which each of them stores.
//
// The vertical is the robust mean (posture.h) of the standing directions of both people in all
// frames of the set. It is shrunk towards that of the whole data set, with the weight of 3
// sequences. The floor is the lower quartile of the heights of the lower feet. The floor's slope is
// not used (docs/decisions/captures.md).
//
// Unchanged: data with fewer than 60 standing poses, with a skeleton without feet, or with people
// who lie rather than lean (a set's vertical is more than 30 degrees from +y).
void LevelSets(Dataset* dataset);

// Parses labels.tsv: a header with the columns `path`, `class`, `from_seconds` and `to_seconds`,
// then one span per line. Returns the spans by path, sorted by their first frame. A span covers the
// frames from the one nearest to `from_seconds` up to the one nearest to `to_seconds`, exclusive.
// Errors: INVALID_ARGUMENT naming line and column, the expected value and the actual one.
absl::StatusOr<std::map<std::string, std::vector<LabelSpan>>> ParseTimeLines(
    absl::string_view text, const std::vector<std::string>& classes, double frame_rate_hz);

// The class that covers most frames; -1 if no class covers any.
int LongestClass(const std::vector<LabelSpan>& labels);

// Cuts a sequence of more than `frames` frames into windows of `frames` that begin `stride` frames
// apart; the last one ends with the sequence. A window's label is the part of the time line in it.
// Omits windows without a class. A sequence that is not longer is returned unchanged.
std::vector<Sequence> CutIntoWindows(const Sequence& sequence, int frames, int stride);

// Indices into Dataset::sequences.
struct Split {
  std::vector<int> train;
  std::vector<int> test;
};

// The indices of all sequences.
std::vector<int> AllSequences(const Dataset& dataset);

// Leave one subject out: test on every sequence with the subject in either role, train on the rest.
// Errors: NOT_FOUND if the data set does not have the subject.
absl::StatusOr<Split> LeaveSubjectOut(const Dataset& dataset, const std::string& subject);

// Splits each class into halves for training and testing. Only `seed` determines the choice. If the
// number is odd, the training half is larger. Both are sorted. A subject may be in both.
// Errors: INVALID_ARGUMENT naming a class of fewer than 2 sequences.
absl::StatusOr<Split> SplitInHalves(const Dataset& dataset, uint64_t seed);

// Moves about `fraction` (in [0, 1)) of each class from train to a validation set: at least one
// sequence of each class and never the last one. Only `seed` determines the choice. Both are
// sorted. Test sequences are not used.
std::vector<int> TakeValidation(const Dataset& dataset, double fraction, uint64_t seed,
                                std::vector<int>* train);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_DATASET_H_
