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
#include "model/motion/joint_rotations.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::client {

// A model version that the server serves.
struct ModelInfo {
  std::string name;
  int version = 0;
  std::vector<std::string> version_labels;
  bool is_default = false;
  std::vector<std::string> interaction_classes;
  std::vector<std::string> joint_names;
  std::vector<motion::Bone> bones;  // indices into joint_names
  std::string root_joint;
  double frame_rate_hz = 0;  // of the network; the server resamples leaders at other rates
  int window_frames = 0;
  bool accepts_follower_start = false;
  bool samples = false;  // results depend on the request's seed and variety
  std::string description;
  std::string terms;  // terms of use of the weights; empty: not specified
  // Anybody may use and pass on the weights and their output for any purpose.
  bool free_for_all_uses = false;
  std::string weights_sha256;  // of the weights file, lower-case hex; empty: unknown
};

// Limits on a request, inclusive.
struct RequestLimits {
  double min_frame_rate_hz = 0;
  double max_frame_rate_hz = 0;
  int min_frames = 0;
  absl::Duration max_duration;
  int max_chunk_frames = 0;
  int max_keyframes = 0;
  float max_abs_weight = 0;
  float max_variety = 0;
  int max_candidates = 0;
  int max_constraints = 0;
  int64_t max_request_bytes = 0;
};

struct ModelDetails {
  ModelInfo model;
  RequestLimits limits;
};

// Durations of the parts of a call.
struct SynthesisTimings {
  absl::Duration first_chunk;  // from the call to its first frames, retries included
  absl::Duration total;        // from the call to its last frame, retries included
  absl::Duration queue;        // in the server's queue, total of all windows
  absl::Duration compute;      // in the network, total of all windows
};

// Consecutive frames.
struct FrameRun {
  int first_frame = 0;
  int frame_count = 0;
};

// What a viewer would notice in a follower, measured by the server. Shares of all frames, 0 to 1; 0
// is perfect.
struct MotionGrade {
  double twisted = 0;         // shoulders are turned against the hips by more than 45 degrees
  double skating = 0;         // both ankles move faster than 10 cm/s
  double leader_skating = 0;  // the same of the leader, for comparison
  double overlapping = 0;     // the heads or the trunks overlap
  // Frames that are twisted or overlap, in ascending order. At most 64; later ones are left out.
  std::vector<FrameRun> bad_runs;
};

// A follower, the model that produced it, and the options that were used.
struct SynthesisResult {
  motion::ClipPair pair;  // the request's leader; the follower in its joints, rate and world
  std::string model_name;
  int model_version = 0;
  std::vector<std::string> interaction_classes;  // every class of the model
  std::string request_id;                        // in the server's log
  uint64_t seed = 0;                             // used by the server
  float variety = 0;                             // used by the server
  int candidates = 1;                            // samples that the model drew for each window
  bool cleaned_up = false;                       // the server cleaned up the follower
  // How the server computes, as "cpu, int16, AVX-512", and its version. Empty: it does not state
  // them.
  std::string engine;
  std::string server_version;
  // Distance of the leader from the model's training data. A tenth of the training leaders have a
  // distance above 1; results for a leader far above 1 are unreliable. Absent if the model has no
  // statistics of its training data.
  std::optional<double> unfamiliarity;
  // Absent if the model's skeleton lacks hips, shoulders or feet.
  std::optional<MotionGrade> grade;
  // Distance that remains at each of SynthesisRequest::constraints, metres.
  std::vector<float> constraint_metres;
  // The follower's joint rotations, if the request asks for them. Metres, y up.
  std::optional<motion::JointRotations> rotations;
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
  // The rotations of these frames, if the request asks for them.
  std::optional<motion::JointRotations> rotations;
};

// Called with every chunk, in frame order. Each frame is passed once, even if the call was retried.
// If it returns an error, the call is cancelled and fails with that error.
using ChunkCallback = std::function<absl::Status(const FollowerChunk&)>;

}  // namespace duet::client

#endif  // DUET_CLIENT_RESULT_H_
