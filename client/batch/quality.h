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

// Quality of an answer: QualityFigures of proto/duet/batch/v1/batch.proto. Figures are absent if
// the skeleton does not have their joints. Units: degrees and metres.
struct Quality {
  std::optional<double> lean_degrees;
  std::optional<double> foot_above_floor_metres;
  std::optional<double> foot_below_floor_metres;
  double distance_metres = 0;
  double penetration_metres = 0;
  double range_of_motion_metres = 0;
  std::string recognised_class;  // empty: not classified
  std::optional<double> class_probability;
  std::optional<MotionGrade> grade;  // of the server, at the leader's frame rate
};

// Requires at least one frame and the joints of the skeleton.
Quality Measure(const motion::ClipPair& pair, const motion::Skeleton& skeleton);

// Classifies the follower of an answer to the class `wanted`. Does nothing if the classifier does
// not know the class. Requires that the pair has the classifier's joints.
void Recognise(const classifier::Classifier& classifier, const std::string& wanted,
               const motion::ClipPair& pair, Quality* quality);

// The limits that an answer exceeds, one text for each; empty if it passes.
std::vector<std::string> WhyRejected(const QualityFilter& filter, const Quality& quality,
                                     const std::optional<double>& unfamiliarity);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_QUALITY_H_
