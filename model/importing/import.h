#ifndef DUET_MODEL_IMPORTING_IMPORT_H_
#define DUET_MODEL_IMPORTING_IMPORT_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/importing/steps.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::importing {

// The source of a data set, and settings that override its files.
struct ImportOptions {
  std::filesystem::path from;   // a folder of motion files
  std::filesystem::path out;    // the data set
  std::string name;             // of the data set; if empty, the folder's
  std::filesystem::path table;  // of pairs; if empty, pairs.tsv in `from`, or file names
  std::string skeleton;         // as in FindSkeleton; if empty, that of the captures
  retargeting::JointOverrides joint_overrides;
  std::optional<double> frame_rate_hz;  // overrides the files' own
  std::optional<double> to_rate_hz;     // of the data set; if absent, the files', at most 30
  std::optional<double> metres_per_unit;
  std::optional<motion::UpAxis> up_axis;
  double longest_seconds = 10;  // longer pairs are cut into equal pieces
  // Properties of classes, by label.
  std::vector<std::string> symmetric, handed, touches;
  std::optional<bool> level;  // if absent, if people lean or float
  bool skip_refused = false;  // continue without unusable pairs
  bool overwrite = false;     // replace a data set at `out`
};

// A value that the files do not state, the inferred value, and the flag that overrides it.
struct Assumption {
  std::string what;
  std::string value;
  std::string flag;
};

struct ImportReport {
  std::vector<Assumption> assumptions;
  std::vector<Refusal> refused;
  int pairs = 0;      // used
  int sequences = 0;  // written; more than the pairs if some were cut
};

// Converts a folder of motion files of two people to a data set (docs/datasets.md): dataset.json,
// <class>/<name>.txt, index.tsv. The data set is written next to `out`, read back, and then moved
// there. An existing one is kept until then.
//
// `report` holds everything up to a failure.
// Errors: INVALID_ARGUMENT for rejected pairs (unless skip_refused) and for values that cannot be
// inferred, naming the flag that specifies them; ALREADY_EXISTS if `out` is not empty and overwrite
// is off, or if it is not a data set.
absl::Status Import(const ImportOptions& options, ImportReport* report);

struct SolvedSequence {
  std::string id;
  double metres = 0;  // mean way of a joint of the person who was moved farther
};

struct SolveReport {
  int sequences = 0;
  double moved = 0;                        // mean way of a joint, metres
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

#endif  // DUET_MODEL_IMPORTING_IMPORT_H_
