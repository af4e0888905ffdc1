#ifndef DUET_CLIENT_BATCH_QUALITY_H_
#define DUET_CLIENT_BATCH_QUALITY_H_

#include <optional>
#include <string>
#include <vector>

#include "client/batch/recipe.h"
#include "client/result.h"
#include "model/classifier/classifier.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// How good an answer is: QualityFigures of proto/duet/batch/v1/batch.proto. Absent where the
// skeleton lacks the joints. Degrees and metres.
struct Quality {
  std::optional<double> lean_degrees;
  std::optional<double> foot_above_floor_metres;
  std::optional<double> foot_below_floor_metres;
  double distance_metres = 0;
  double penetration_metres = 0;
  double range_of_motion_metres = 0;
  std::string recognised_class;  // empty: nothing looked
  std::optional<double> class_probability;
};

// Requires a frame, and joints that are the skeleton's.
Quality Measure(const motion::ClipPair& pair, const motion::Skeleton& skeleton);

// What the classifier makes of it, asked for `wanted`. Nothing of a class that it does not know.
// Requires that the pair has its joints.
void Recognise(const classifier::Classifier& classifier, const std::string& wanted,
               const motion::ClipPair& pair, Quality* quality);

// What of an answer the filter does not let pass, a sentence each; empty: it passes.
std::vector<std::string> WhyRejected(const QualityFilter& filter, const Quality& quality,
                                     const std::optional<double>& unfamiliarity);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_QUALITY_H_
