#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_

#include <cstdint>
#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/experiments/synthetic_job.h"

// How a synthetic set is asked of a server and comes back:
//
//   manifest.tsv               for `duet batch --manifest`: leader, labels, partner_direction, half
//   leaders/<set>/<id>.json    the leaders, one person each (docs/formats.md)
//
// All of it is in the level world that the data set was read into: servers learnt there. half is
// the seed of SplitInHalves whose training half the generator and the leaders come from. The answer
// is a data set of `duet batch` in a layout of captures (recipes/sbu_300.textproto, docs/batch.md).

namespace duet::evaluation::experiments {

// Writes the manifest and the leaders; makes the folders where they are missing.
absl::Status WriteSyntheticJobs(const dataset::Dataset& dataset,
                                const std::vector<SyntheticJob>& jobs, uint64_t half,
                                const std::filesystem::path& folder);

struct SyntheticSet {
  uint64_t half = 0;
  std::vector<dataset::Sequence> sequences;  // the leader as asked and the follower as answered
};

// Reads such a data set as captures are read, in the world that it was asked in, and of its
// index.jsonl the half and the partner's direction. Errors: NOT_FOUND for a missing file;
// INVALID_ARGUMENT naming file, line, what came and what was wanted: joints, classes or a frame
// rate other than the data's, an index of other clips, halves that differ or that nobody told.
absl::StatusOr<SyntheticSet> ReadSyntheticSet(const dataset::Dataset& dataset,
                                              const std::filesystem::path& folder);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_
