#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_

#include <cstdint>
#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/experiments/synthetic_job.h"

// The files by which a synthetic set is requested from a server and read back:
//
//   manifest.tsv               for `duet batch --manifest`: leader, labels, partner_direction, half
//   leaders/<set>/<id>.json    the leaders, one person each (docs/formats.md)
//
// Everything is in the level world of the data set, in which the models were trained. half is the
// seed of SplitInHalves whose training half the generator and the leaders come from. The answer is
// a data set of `duet batch` in a layout of captures (recipes/sbu_300.textproto, docs/batch.md).

namespace duet::evaluation::experiments {

// Writes the manifest and the leaders; creates missing folders.
absl::Status WriteSyntheticJobs(const dataset::Dataset& dataset,
                                const std::vector<SyntheticJob>& jobs, uint64_t half,
                                const std::filesystem::path& folder);

struct SyntheticSet {
  uint64_t half = 0;
  std::vector<dataset::Sequence> sequences;  // the requested leader and the follower of the answer
};

// Reads such a data set like captures, in the world of the request, and the half and the partner's
// direction from its index.jsonl. Errors: NOT_FOUND for a missing file; INVALID_ARGUMENT naming
// file and line for joints, classes or a frame rate other than the data's, an index of other clips,
// and halves that differ or are missing.
absl::StatusOr<SyntheticSet> ReadSyntheticSet(const dataset::Dataset& dataset,
                                              const std::filesystem::path& folder);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_FILES_H_
