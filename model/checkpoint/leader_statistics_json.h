#ifndef DUET_MODEL_CHECKPOINT_LEADER_STATISTICS_JSON_H_
#define DUET_MODEL_CHECKPOINT_LEADER_STATISTICS_JSON_H_

#include <nlohmann/json.hpp>
#include <string>

#include "absl/status/statusor.h"
#include "model/engine/leader_statistics.h"
#include "model/motion/skeleton.h"

namespace duet::checkpoint {

// The statistics of the training leaders, as manifests store them:
//   {"features": [{"name", "mean", "deviation"}, ...], "scale": 1.3}
// Every feature must be one of the skeleton; features may be absent.
inline constexpr char kLeaderStatistics[] = "leader_statistics";

absl::StatusOr<engine::LeaderStatistics> ReadLeaderStatistics(const nlohmann::json& value,
                                                              const motion::Skeleton& skeleton,
                                                              const std::string& path);

nlohmann::ordered_json LeaderStatisticsToJson(const engine::LeaderStatistics& statistics);

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_LEADER_STATISTICS_JSON_H_
