#ifndef DUET_SERVER_SERVICE_VALIDATOR_H_
#define DUET_SERVER_SERVICE_VALIDATOR_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/live_synthesis.h"
#include "model/engine/model_description.h"
#include "model/motion/motion_limits.h"
#include "model/motion/poses.h"
#include "server/batching/window_scheduler.h"
#include "server/service/reply_mapping.h"

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

// Returns the priority of a request. Defaults to interactive; absent if the value is unknown.
std::optional<batching::Priority> PriorityOf(const v1::SynthesizeRequest& request);

// A valid SynthesizeRequest, converted to the model's joints, units and classes.
struct ValidatedRequest {
  engine::ClipRequest clip;
  ReplyMapping reply;
  int chunk_frames = 0;
  batching::Priority priority = batching::Priority::kInteractive;
};

// Validates every field of a request against a model and the limits. Returns INVALID_ARGUMENT or
// FAILED_PRECONDITION with a BadRequest that names every invalid field. `request` is untrusted.
absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits);

// Like ValidateRequest, for requests whose leader has other limits than RequestLimits says, or
// none. Label keyframes lie before frame `label_frames`. Violations have the given prefix.
absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits, std::string prefix,
                                                 uint32_t label_frames);

// Frames of a session are numbered below this: more than 50 days at 240 frames per second.
inline constexpr int kMaxLiveFrames = 1 << 30;

// A valid LiveStart, converted to the model's joints, units and classes.
struct ValidatedLiveStart {
  engine::LiveRequest live;
  ReplyMapping reply;
  int plan_frames = 0;
  // The caller wants joint rotations. Frame 0 of both motions, [1, joints] in the model's joint
  // order and level metres, as far as they are known: LiveRig needs them.
  bool rotations = false;
  motion::Poses rig_leader = {};
  motion::Poses rig_follower = {};
};

// Like ValidateRequest, for the first message of a session.
absl::StatusOr<ValidatedLiveStart> ValidateLiveStart(v1::LiveStart start,
                                                     const engine::ModelDescription& model,
                                                     const RequestLimits& limits);

// Reads leader frames: in the model's joint order, level world metres. `check_size`: whether they
// have to show a person. Returns INVALID_ARGUMENT with every invalid field.
absl::StatusOr<motion::Poses> ReadLeaderFrames(const v1::LeaderFrames& frames,
                                               const ReplyMapping& format,
                                               const engine::ModelDescription& model,
                                               const RequestLimits& limits, bool check_size);

// A valid LabelChange.
struct ValidatedLabelChange {
  int frame = 0;
  int ease_frames = 0;
  std::vector<float> weights;  // [classes]
};

// `next_frame`: the first follower frame that is not final when the message is read. Returns
// INVALID_ARGUMENT with every invalid field.
absl::StatusOr<ValidatedLabelChange> ReadLabelChange(const v1::LabelChange& change, int next_frame,
                                                     double frame_rate_hz,
                                                     const engine::ModelDescription& model,
                                                     const RequestLimits& limits);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATOR_H_
