#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_

#include <cstdint>
#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/experiments/synthetic_job.h"

// A folder through which a synthetic set passes on its way to a server and back:
//
//   jobs.tsv             a header, then one motion a line: id, class, half, labels, partner
//   leaders/<id>.json    what is asked, one person (docs/formats.md)
//   followers/<id>.json  what `duet synthesize` answered, both people
//
// labels are "kick=1.1;hug=0.2"; partner is "x,y,z", the direction from leader to follower, or "-";
// All of it is in the level world that the data set was read into: servers learnt there.
// half is the seed of SplitInHalves whose training half the generator and the leaders come from.

namespace duet::evaluation::experiments {

// Writes jobs.tsv and the leaders; makes the three folders where they are missing.
absl::Status WriteSyntheticJobs(const dataset::Dataset& dataset,
                                const std::vector<SyntheticJob>& jobs, uint64_t half,
                                const std::filesystem::path& folder);

struct SyntheticSet {
  uint64_t half = 0;
  std::vector<dataset::Sequence> sequences;  // the leader as asked and the follower as answered
};

// Reads jobs.tsv and every follower. Strict. Errors: NOT_FOUND for a missing file;
// INVALID_ARGUMENT naming file, line, what came and what was wanted: an unknown class, an id that
// is no file name, halves that differ, no job at all; an answer of one person alone, of other
// joints or another frame rate than the data's.
absl::StatusOr<SyntheticSet> ReadSyntheticSet(const dataset::Dataset& dataset,
                                              const std::filesystem::path& folder);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_
