#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TILTED_ANSWERS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TILTED_ANSWERS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/experiments/answers.h"

namespace duet::evaluation::experiments {

// What the tilt of a camera costs, and what levelling saves. Every figure is a mean over sequences
// and samples.
struct TiltedFigures {
  std::string name;
  // Afd in metres from the captured follower, in the level world.
  double error_metres = 0;
  double levelled_share = 0;    // of the requests with a vertical
  double residual_degrees = 0;  // between the true vertical and that of the request
};

// A camera that captures the level world of the data set.
struct Camera {
  double tilt_degrees = 10;
  // Direction of the tilt about +y from +x towards +z, degrees. Absent, with any tilt: each set as
  // it was captured (Sequence::levelling).
  std::optional<double> azimuth_degrees = 0;
};

// Answers leaders as the camera captures them: never tilted, as sent, levelled by what one file
// (two people) shows, levelled by what all files of the set show, and levelled by the true
// vertical. Evidence is VerticalEvidence's; only a strong estimate levels, as in `duet synthesize
// --level auto` and `duet batch`. Errors: those of AnswerWithSamples.
absl::StatusOr<std::vector<TiltedFigures>> AnswerTilted(const engine::Synthesizer& synthesizer,
                                                        const dataset::Dataset& dataset,
                                                        const std::vector<int>& sequences,
                                                        StartGiven start, const AskedSamples& asked,
                                                        const Camera& camera);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TILTED_ANSWERS_H_
