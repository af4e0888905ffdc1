#ifndef DUET_MODEL_IMPORTING_PAIRING_H_
#define DUET_MODEL_IMPORTING_PAIRING_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::importing {

// Two people's motion, found but not read.
struct PairFiles {
  std::string label;   // the interaction class: lower case, words joined by '_'
  std::string name;    // of the sequence within its class
  std::string first;   // the file of one person, below the folder of captures
  std::string second;  // of the other; the same file where one holds both
  // "name" or "table" where that says that `first` leads; empty where nothing does.
  std::string leader_source;
  std::vector<std::string> subjects;  // leader's first, where the table says
};

// A pair that is left out, and why.
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
//   kick_01_a.bvh, kick_01_b.bvh            the last word tells whose it is
//   kick/01.leader.csv, kick/01.follower.csv
//   kick/01/leader.bvh, kick/01/follower.bvh
//   kick/01.npy                             no such word: both people in one file
//
// Words, in either case and after '_', '-', '.' or a blank: leader and follower, which tell who
// leads; a and b, p1 and p2, person1 and person2, actor1 and actor2, first and second, left and
// right, which do not. The label is the first folder's name, or that of a file which lies in none,
// without the number at its end.
Pairing PairByName(const std::vector<std::string>& files);

// The same by a table: a header, then a pair a line, separated by tabs. Columns `leader`,
// `follower` (empty: the leader's file holds both) and `label`; `subjects` (names separated by
// commas) may be there, others are left alone. A file that `files` does not have is refused.
// Errors: INVALID_ARGUMENT "source:line: ... came ..., wanted ...".
absl::StatusOr<Pairing> PairByTable(absl::string_view table, absl::string_view source,
                                    const std::vector<std::string>& files);

// A class's name: lower case, everything but letters and digits as one '_'.
std::string ToLabel(absl::string_view text);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_PAIRING_H_
