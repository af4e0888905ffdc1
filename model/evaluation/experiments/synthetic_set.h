#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_SET_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_SET_H_

#include <cstdint>
#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"

namespace duet::evaluation::experiments {

// A request for a synthetic motion.
struct SyntheticJob {
  dataset::Sequence sequence;  // a leader of its class; the follower has no positions
  std::vector<float> labels;   // [classes], the label vector
};

struct SyntheticPlanOptions {
  int match = 25;  // motions per class by interaction match
  int mix = 25;    // motions per class by interaction mix
  uint64_t seed = 0;
};

// The jobs for synthetic followers of every class; only the seed determines the draw.
//
// Leaders are those of `train`, those of each class in turn as often as needed, with variations:
// both people exchanged in half of the clips of symmetric classes, bodies larger or smaller by up
// to 8 %, turned by about 6 degrees, played up to 10 % faster or slower. Interaction match gives
// the leader's class a weight of 0.75 to 1.25. Interaction mix gives it 0.75 to 1, and one other
// class 0.1 to 0.35, so that the motion stays one of its class.
//
// Source: paper section 4 (300 synthetic motions, 50 a class, "25 + 25"), which does not say how it
//         varies leaders and weights; read as 25 by interaction match and 25 by interaction mix.
// Shapes: returns match + mix jobs per class, sorted by class; ids "<class>-<place in the set>".
// Requires a sequence of every class in `train`; mix above 0 requires two classes.
std::vector<SyntheticJob> PlanSyntheticSet(const dataset::Dataset& dataset,
                                           const std::vector<int>& train,
                                           const SyntheticPlanOptions& options);

// Answers the jobs in this process, through the same windows as on a server.
// Errors: those of CheckModelFits; a failure of the network, naming the job.
absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs);

// The files by which a synthetic set is requested from a server and read back:
//
//   manifest.tsv               for `duet batch --manifest`: leader, labels, partner_direction, half
//   leaders/<set>/<id>.json    the leaders, one person each (docs/formats.md)
//
// Everything is in the level world of the data set, in which the models were trained. half is the
// seed of SplitInHalves whose training half the generator and the leaders come from. The answer is
// a data set of `duet batch` in a layout of captures (recipes/sbu_300.textproto, docs/batch.md).

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

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHETIC_SET_H_
