#ifndef DUET_MODEL_CHECKPOINT_DIRECTION_JSON_H_
#define DUET_MODEL_CHECKPOINT_DIRECTION_JSON_H_

#include <nlohmann/json.hpp>
#include <optional>

#include "model/base/strict_json.h"
#include "model/engine/direction_estimate.h"
#include "model/motion/skeleton.h"

// How a leader's motion tells where the partner is, as manifests write it.
namespace duet::checkpoint {

// The manifest's field. It may be absent.
inline constexpr char kPartnerDirection[] = "partner_direction";

// Reads the field from the manifest's own reader, which is told what is wrong: lists that are not
// as long as the skeleton's features, deviations that are not above 0, a skeleton without hips.
std::optional<engine::DirectionRegression> ReadDirectionRegression(const motion::Skeleton& skeleton,
                                                                   base::ObjectReader* manifest);

nlohmann::ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_DIRECTION_JSON_H_
