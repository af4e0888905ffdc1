#ifndef DUET_SERVER_SERVICE_VALIDATE_LIVE_H_
#define DUET_SERVER_SERVICE_VALIDATE_LIVE_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
#include "model/engine/live_synthesis.h"
#include "model/engine/model_description.h"
#include "model/motion/poses.h"
#include "server/service/reply_mapping.h"
#include "server/service/request_limits.h"

namespace duet::server::service {

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

// Validates every field of the first message against a model and the limits. Returns
// INVALID_ARGUMENT or FAILED_PRECONDITION with a BadRequest that names every invalid field. `start`
// is untrusted.
absl::StatusOr<ValidatedLiveStart> ValidateLiveStart(v1::LiveStart start,
                                                     const engine::ModelDescription& model,
                                                     const RequestLimits& limits);

// Reads leader frames: in the model's joint order, level world metres. Returns INVALID_ARGUMENT
// with every invalid field.
absl::StatusOr<motion::Poses> ReadLeaderFrames(const v1::LeaderFrames& frames,
                                               const ReplyMapping& format,
                                               const RequestLimits& limits);

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

#endif  // DUET_SERVER_SERVICE_VALIDATE_LIVE_H_
