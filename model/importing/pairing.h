#ifndef DUET_MODEL_IMPORTING_PAIRING_H_
#define DUET_MODEL_IMPORTING_PAIRING_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

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

// Pairs files by a tab-separated table: a header, then one pair per line. The columns `leader`,
// `follower` (empty if the leader's file holds both) and `label` are required, `subjects` (names
// separated by commas) is optional, and others are ignored. A pair with a file not in `files` is
// rejected.
// Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ...".
absl::StatusOr<Pairing> PairByTable(absl::string_view table, absl::string_view source,
                                    const std::vector<std::string>& files);

// A class's name: in lower case, with '_' for each run of other characters than letters and digits.
std::string ToLabel(absl::string_view text);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_PAIRING_H_
