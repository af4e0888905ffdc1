#ifndef DUET_MODEL_IMPORTING_SOLVE_H_
#define DUET_MODEL_IMPORTING_SOLVE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace duet::importing {

// The bodies of some people.
struct BodyFigures {
  double bone_noise = 0;      // deviation of the length of a bone, mean of all bones, metres
  double narrowest_hips = 1;  // width in any frame over the person's median
  double widest_hips = 1;
  double knee_degrees = 0;   // mean bend
  double slower_foot = 0;    // mean speed of the foot that moves less, m/s
  double hips_over_leg = 0;  // height of the hips above the lower foot over the leg's length
};

// How far a part of the body was moved.
struct MovedPart {
  std::string part;
  double metres = 0;  // mean of its joints, over all people and frames
};

struct SolvedSequence {
  std::string id;
  double metres = 0;  // mean way of a joint of the person who was moved farther
};

struct SolveReport {
  int sequences = 0;
  double moved = 0;  // mean way of a joint, metres
  std::vector<MovedPart> parts;
  BodyFigures before;
  BodyFigures after;
  std::vector<SolvedSequence> most_moved;  // the five that were moved farthest, the farthest first
};

// Solves both people of every sequence of a data set (solver/person.h) and writes the result to
// `out` as a data set of your own: in metres, level, with the same sequences, leaders, subjects,
// classes and time lines. Where bones vary, as in captures of a depth camera, the two people of a
// sequence get one floor between theirs; where they do not, everybody keeps the own floor, because
// shoes differ.
//
// Errors: those of ReadDataset for `from`; of CheckOut and WriteDataset for `out`; INVALID_ARGUMENT
// naming what the skeleton lacks.
absl::Status Solve(const std::filesystem::path& from, const std::filesystem::path& out,
                   bool overwrite, SolveReport* report);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_SOLVE_H_
