#ifndef DUET_MODEL_CHECKPOINT_LEADER_JSON_H_
#define DUET_MODEL_CHECKPOINT_LEADER_JSON_H_

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "model/base/strict_json.h"
#include "model/engine/direction_estimate.h"
#include "model/engine/leader_statistics.h"
#include "model/motion/skeleton.h"

// What manifests know of the leaders of the training data.

namespace duet::checkpoint {

// The statistics of the training leaders, as manifests store them:
//   {"features": [{"name", "mean", "deviation"}, ...], "scale": 1.3}
// Every feature must be one of the skeleton; features may be absent.
inline constexpr char kLeaderStatistics[] = "leader_statistics";

absl::StatusOr<engine::LeaderStatistics> ReadLeaderStatistics(const nlohmann::json& value,
                                                              const motion::Skeleton& skeleton,
                                                              const std::string& path);

nlohmann::ordered_json LeaderStatisticsToJson(const engine::LeaderStatistics& statistics);

// The regression of the partner's direction on the leader's motion, as manifests store it. The
// field may be absent.
inline constexpr char kPartnerDirection[] = "partner_direction";

// Reads the field from the reader of the manifest. Records errors in it: lists of another length
// than the skeleton's features, deviations that are not above 0, a skeleton without hips, another
// number of classes.
std::optional<engine::DirectionRegression> ReadDirectionRegression(const motion::Skeleton& skeleton,
                                                                   int classes,
                                                                   base::ObjectReader* manifest);

nlohmann::ordered_json DirectionRegressionToJson(const engine::DirectionRegression& regression);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_LEADER_JSON_H_
