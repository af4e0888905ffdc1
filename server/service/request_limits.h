#ifndef DUET_SERVER_SERVICE_REQUEST_LIMITS_H_
#define DUET_SERVER_SERVICE_REQUEST_LIMITS_H_

#include <cstddef>

#include "model/motion/motion_limits.h"

namespace duet::server::service {

// Limits on a request. GetModel returns them to callers; every error names the limit it enforces.
struct RequestLimits {
  double min_frame_rate_hz = 1;
  double max_frame_rate_hz = motion::kMaxServedFrameRateHz;
  int min_frames = 2;
  double max_duration_seconds = 600;
  int max_chunk_frames = 240;
  int default_chunk_frames = 30;
  int max_label_keyframes = 4096;
  float max_abs_weight = 2;
  float max_variety = 2;
  int max_candidates = 16;
  int max_delay_frames = 10;
  int max_plan_frames = 30;
  int max_constraints = 64;
  // Distance of a constraint's position from the leader's root.
  float max_constraint_metres = 20;
  // Of the frames in one message of a live session.
  double max_live_seconds = 10;
  // Larger than any room, and small enough for float arithmetic on positions.
  float max_abs_coordinate_metres = 10000;
  // Set by the operator. ServerConfig has the default.
  std::size_t max_request_bytes = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REQUEST_LIMITS_H_
