#ifndef DUET_MODEL_IMPORTING_IMPORT_H_
#define DUET_MODEL_IMPORTING_IMPORT_H_

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/importing/capture_skeleton.h"
#include "model/importing/pairing.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::importing {

// Where a data set comes from and what its maker knows better than its files.
struct ImportOptions {
  std::filesystem::path from;   // a folder of motion files
  std::filesystem::path out;    // the data set
  std::string name;             // of the data set; empty: the folder's
  std::filesystem::path table;  // who is paired with whom; empty: pairs.tsv in `from`, or names
  SkeletonOptions skeleton;
  retargeting::JointOverrides joint_overrides;
  std::optional<double> frame_rate_hz;  // replaces what the files say
  std::optional<double> to_rate_hz;     // of the data set; absent: as found, 30 at most
  std::optional<double> metres_per_unit;
  std::optional<motion::UpAxis> up_axis;
  double longest_seconds = 10;  // longer pairs are cut into equal pieces
  // Properties of classes, by label.
  std::vector<std::string> symmetric, handed, touches;
  std::map<std::string, std::vector<std::string>> effectors;  // joints of the data set
  std::optional<bool> level;                                  // absent: where people lean or float
  bool skip_refused = false;  // go on without pairs that cannot be used
  bool overwrite = false;     // replace a data set that is at `out`
};

// Something that the files left open, what was made of it, and the flag that changes it.
struct Assumption {
  std::string what;
  std::string value;
  std::string flag;
};

struct ImportReport {
  std::vector<Assumption> assumptions;
  std::vector<Refusal> refused;
  int pairs = 0;      // used
  int sequences = 0;  // written; more than the pairs where some were cut
};

// Turns a folder of motion files of two people into a data set (docs/datasets.md): dataset.json,
// <class>/<name>.txt, index.tsv. It is written beside its place and moved there once it reads back;
// what was there is kept until then.
//
// `report` is filled as far as things went, also on failure.
// Errors: INVALID_ARGUMENT for pairs that are refused (unless skip_refused) and for anything that
// cannot be found in the files, naming the flag that says it; ALREADY_EXISTS when `out` holds
// something and overwrite is off, or something that is no data set.
absl::Status Import(const ImportOptions& options, ImportReport* report);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_IMPORT_H_
