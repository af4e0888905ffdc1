#ifndef DUET_CLIENT_RESULT_H_
#define DUET_CLIENT_RESULT_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "model/motion/clip.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::client {

// A model version that the server answers with.
struct ModelInfo {
  std::string name;
  int version = 0;
  std::vector<std::string> version_labels;
  bool is_default = false;
  std::vector<std::string> interaction_classes;
  std::vector<std::string> joint_names;
  std::vector<motion::Bone> bones;  // indices into joint_names
  std::string root_joint;
  double frame_rate_hz = 0;  // the network's own; any other is resampled
  int window_frames = 0;
  bool accepts_follower_start = false;
  bool samples = false;  // answers depend on the request's seed and variety
  std::string description;
  std::string terms;           // of using the weights; empty: not stated
  std::string weights_sha256;  // of the weights file, lower-case hex; empty: not known
};

// What a request must keep to.
struct RequestLimits {
  double min_frame_rate_hz = 0;
  double max_frame_rate_hz = 0;
  int min_frames = 0;
  absl::Duration max_duration;
  int max_chunk_frames = 0;
  int max_keyframes = 0;
  float max_abs_weight = 0;
  float max_variety = 0;
  int64_t max_request_bytes = 0;
};

struct ModelDetails {
  ModelInfo model;
  RequestLimits limits;
};

// Where the time of a call went.
struct SynthesisTimings {
  absl::Duration first_chunk;  // from the call to its first frames, retries included
  absl::Duration total;        // from the call to its last frame, retries included
  absl::Duration queue;        // waiting in the server, over all windows
  absl::Duration compute;      // in the network, over all windows
};

// A follower, and who made it.
struct SynthesisResult {
  motion::ClipPair pair;  // the request's leader; the follower in its joints, rate and world
  std::string model_name;
  int model_version = 0;
  std::vector<std::string> interaction_classes;  // every class of the model
  std::string request_id;                        // as in the server's log
  uint64_t seed = 0;                             // that the server used
  float variety = 0;                             // the same
  bool cleaned_up = false;                       // whether the server corrected it, asked to or not
  // How far the request is from what the model was trained on: 1 as far as the farthest tenth of
  // the training leaders. Absent when the model does not know.
  std::optional<double> unfamiliarity;
  int window_count = 0;  // network windows that were evaluated
  int attempt_count = 0;
  SynthesisTimings timings;
};

// Consecutive frames of the follower, as they arrive.
//
// Shapes: poses [frames, joints], in the leader's joint order.
// Units:  metres, y up.
struct FollowerChunk {
  int first_frame = 0;
  motion::Poses poses;
};

// Called with every chunk, in frame order; each frame comes once, even where the call was retried.
// A status that is not OK cancels the call, which then fails with that status.
using ChunkCallback = std::function<absl::Status(const FollowerChunk&)>;

}  // namespace duet::client

#endif  // DUET_CLIENT_RESULT_H_
