#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZE_JOBS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZE_JOBS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/experiments/synthetic_job.h"

namespace duet::evaluation::experiments {

// Answers the jobs in this process, through the same windows as on a server.
// Errors: those of CheckModelFits; a failure of the network, naming the job.
absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_SYNTHESIZE_JOBS_H_
