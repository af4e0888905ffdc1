#ifndef DUET_MODEL_CHECKPOINT_DIRECTION_JSON_H_
#define DUET_MODEL_CHECKPOINT_DIRECTION_JSON_H_

#include <nlohmann/json.hpp>
#include <optional>

#include "model/base/strict_json.h"
#include "model/engine/direction_estimate.h"
#include "model/motion/skeleton.h"

// The regression of the partner's direction on the leader's motion, as manifests store it.
namespace duet::checkpoint {

// The field of the manifest, which may be absent.
inline constexpr char kPartnerDirection[] = "partner_direction";

// Reads the field from the reader of the manifest. Records errors in it: lists of another length
// than the skeleton's features, deviations that are not above 0, a skeleton without hips, another
// number of classes.
std::optional<engine::DirectionRegression> ReadDirectionRegression(const motion::Skeleton& skeleton,
                                                                   int classes,
                                                                   base::ObjectReader* manifest);

nlohmann::ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_DIRECTION_JSON_H_
