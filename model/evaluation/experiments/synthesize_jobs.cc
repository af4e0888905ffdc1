#include "model/evaluation/experiments/synthesize_jobs.h"

#include "absl/strings/str_cat.h"
#include "model/evaluation/experiments/synthesizer_method.h"

namespace duet::evaluation::experiments {

absl::StatusOr<std::vector<dataset::Sequence>> SynthesizeJobs(
    const dataset::Dataset& dataset, const engine::Synthesizer& synthesizer,
    const std::vector<SyntheticJob>& jobs) {
  absl::Status status = CheckModelFits(synthesizer.description(), dataset);
  if (!status.ok()) return status;
  std::vector<dataset::Sequence> answered;
  for (const SyntheticJob& job : jobs) {
    absl::StatusOr<motion::Poses> follower =
        SynthesizeSequence(synthesizer, job.sequence, job.labels, StartGiven::kNone);
    if (!follower.ok()) {
      return absl::Status(follower.status().code(),
                          absl::StrCat(job.sequence.id, ": ", follower.status().message()));
    }
    answered.push_back(job.sequence);
    answered.back().pair.follower.poses = *std::move(follower);
  }
  return answered;
}

}  // namespace duet::evaluation::experiments
