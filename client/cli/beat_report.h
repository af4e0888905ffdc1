#ifndef DUET_CLIENT_CLI_BEAT_REPORT_H_
#define DUET_CLIENT_CLI_BEAT_REPORT_H_

#include <string>

#include "client/cli/output.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// How the steps of leader and follower fall on the beat, as text and as JSON. Steps more than half
// a beat before the first beat do not count. Both functions require `synthesis.beat`.
//
//   {"bpm", "offset_seconds", "leader": {"steps", "mean_distance_ms", "spread_ms"},
//    "follower": ...}
// Figures that too few steps have are null. Without feet, leader and follower are null, and "note"
// reports it.
std::string DescribeBeat(const Synthesis& synthesis);
nlohmann::json BeatJson(const Synthesis& synthesis);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BEAT_REPORT_H_
