#ifndef DUET_MODEL_DATASET_LEADER_SIDE_H_
#define DUET_MODEL_DATASET_LEADER_SIDE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"

namespace duet::dataset {

// The leader among the two people of a file: the first one (left) or the second (right).
enum class LeaderSide { kLeft, kRight, kUnknown };

// The entry of an index.tsv for one file.
struct IndexEntry {
  LeaderSide leader_side = LeaderSide::kUnknown;
  std::vector<std::string> subjects;  // from the column of that name, if there is one
  bool guessed = false;               // its column leader_source exists and begins with "guess"
  int line = 0;                       // for messages
};

// Parses index.tsv, a table (table.h) of one file per line. The columns `path` and `leader_side`
// (left, right, unknown) are required; `subjects` (names separated by commas) and `leader_source`
// are optional; other columns are ignored. Returns the entries by path. Errors: INVALID_ARGUMENT
// naming the line, the expected value and the actual one.
absl::StatusOr<std::map<std::string, IndexEntry>> ParseIndex(absl::string_view text);

// The largest distance of any effector from its position in the first frame, relative to the root
// joint, metres.
float PeakDisplacement(const motion::Clip& clip, int root, const std::vector<int>& effectors);

// The motion rule: the leader is the person whose effector has the larger peak displacement from
// its position in the first frame, relative to the person's own root joint. On a tie, the left
// person. Source: data set notes; on SBU it agrees with a hand annotation on all kicks, on 26 of 33
// pushes and 28 of 31 punches, and is no better than chance for symmetric classes.
LeaderSide LeaderByMotion(const motion::Clip& left, const motion::Clip& right, int root,
                          const std::vector<int>& effectors);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_LEADER_SIDE_H_
