#ifndef DUET_MODEL_IMPORTING_STEPS_H_
#define DUET_MODEL_IMPORTING_STEPS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/dataset/dataset.h"
#include "model/dataset/layout.h"
#include "model/dataset/leader_side.h"
#include "model/motion/body_part.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"

// The steps of an import (import.h).

namespace duet::importing {

// The files of two people, not yet read.
struct PairFiles {
  std::string label;   // the interaction class: lower case, words joined by '_'
  std::string name;    // of the sequence within its class
  std::string first;   // the file of one person, below the folder of captures
  std::string second;  // of the other; the same file if it holds both
  // "name" or "table", whichever states that `first` leads; empty if neither does.
  std::string leader_source;
  std::vector<std::string> subjects;  // the leader's first, if the table has them
};

// A rejected pair, and the reason.
struct Refusal {
  std::string name;
  std::string reason;
};

struct Pairing {
  std::vector<PairFiles> pairs;
  std::vector<Refusal> refused;
};

// Pairs files (paths below one folder, with '/') by their names:
//
//   kick_01_a.bvh, kick_01_b.bvh            the last word denotes the person
//   kick/01.leader.csv, kick/01.follower.csv
//   kick/01/leader.bvh, kick/01/follower.bvh
//   kick/01.npy                             no such word: both people in one file
//
// These words, in either case and after '_', '-', '.' or a space, denote a person: leader and
// follower, which state who leads; a and b, p1 and p2, person1 and person2, actor1 and actor2,
// first and second, left and right, which do not. The label is the name of the first folder, or of
// a file in no folder, without the number at its end.
Pairing PairByName(const std::vector<std::string>& files);

// Pairs files by a table (dataset/table.h) of one pair per line. The columns `leader`, `follower`
// (empty if the leader's file holds both) and `label` are required, `subjects` (names separated by
// commas) is optional, and others are ignored. A pair with a file not in `files` is rejected.
// Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ...".
absl::StatusOr<Pairing> PairByTable(absl::string_view table, absl::string_view source,
                                    const std::vector<std::string>& files);

// A class's name: in lower case, with '_' for each run of other characters than letters and digits.
std::string ToLabel(absl::string_view text);

// The skeleton of an imported data set.
struct CaptureSkeleton {
  motion::Skeleton skeleton;  // with hips and feet
  std::vector<motion::BodyPart> parts;
  motion::JointPair hands;
  std::string origin;              // its source
  std::vector<std::string> notes;  // the assumptions
};

// Finds the skeleton of a data set: the one that `specified` names, "sbu" for the 15 joints of
// Duet's own models, or a file with the `skeleton` object of dataset.json. If it is empty, that of
// the capture `file`. BVH: its hierarchy, without End Sites and without joints at the
// position of their parent. SBU text, NPY, and CSV and JSON with their names: the 15 joints of SBU.
// Joints below hands and head are omitted. Known joints get Duet's names (left_hip, left_foot,
// left_hand, neck), on which other code relies; others are named by side and word (left_toe_base).
// Errors: INVALID_ARGUMENT naming the file, the missing item, and the flag that specifies it.
absl::StatusOr<CaptureSkeleton> FindSkeleton(const std::filesystem::path& file,
                                             const std::string& specified);

// A pair that has been read.
struct Capture {
  PairFiles files;
  motion::Clip first;  // of the data set's joints
  motion::Clip second;
};

// A sequence to be written to a data set.
struct ImportedSequence {
  Capture capture;  // metres, y up
  dataset::LeaderSide leader_side = dataset::LeaderSide::kUnknown;
  std::string leader_source;
  std::vector<dataset::LabelSpan> labels;  // on a time line; empty: the class of its folder
};

// Checks that WriteDataset may write `out`: it does not exist, is an empty folder, or is a data set
// and `overwrite` is set. ALREADY_EXISTS otherwise.
absl::Status CheckOut(const std::filesystem::path& out, bool overwrite);

// Writes a data set that ParseDatasetLayout and ParseIndex read. The write is atomic: the data set
// is written next to `out`, read back, and then moved there. Replaces anything that CheckOut
// accepts. Requires a layout in metres, y up.
absl::Status WriteDataset(const std::filesystem::path& out, const dataset::DatasetLayout& layout,
                          const std::vector<ImportedSequence>& sequences);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_STEPS_H_
