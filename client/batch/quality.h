#ifndef DUET_CLIENT_BATCH_QUALITY_H_
#define DUET_CLIENT_BATCH_QUALITY_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/batch/recipe.h"
#include "client/result.h"
#include "model/classifier/classifier.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// Quality of an answer: the figures of QualityFigures of proto/duet/batch/v1/batch.proto by their
// names there. Figures are absent if the skeleton does not have their joints.
struct Quality {
  std::map<std::string, double> figures;
  std::string recognised_class;         // empty: not classified
  std::optional<double> unfamiliarity;  // IndexEntry.unfamiliarity
};

// The columns of tables, in their order.
inline constexpr char kRecognisedClass[] = "recognised_class";
inline constexpr const char* kQualityFields[] = {
    "lean_degrees",    "foot_above_floor_metres", "foot_below_floor_metres",
    "distance_metres", "penetration_metres",      "range_of_motion_metres",
    kRecognisedClass,  "class_probability",       "twisted",
    "skating",         "leader_skating",          "overlapping"};

// `pair`: of the result, level and at any rate. Requires at least one frame and the joints of the
// skeleton.
Quality Measure(const motion::ClipPair& pair, const motion::Skeleton& skeleton,
                const SynthesisResult& result);

// Classifies the follower of an answer to the class `wanted`. Does nothing if the classifier does
// not know the class. Requires that the pair has the classifier's joints.
void Recognise(const classifier::Classifier& classifier, const std::string& wanted,
               const motion::ClipPair& pair, Quality* quality);

// The limits that an answer exceeds, one text for each; empty if it passes.
std::vector<std::string> WhyRejected(const v1::QualityFilter& filter, const Quality& quality);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_QUALITY_H_
