#ifndef DUET_CLIENT_REQUEST_H_
#define DUET_CLIENT_REQUEST_H_

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/vec3.h"

namespace duet::client {

// Which model answers. Default: the server's default model, in its newest version.
struct ModelChoice {
  std::string name;            // empty: the server's default model
  std::optional<int> version;  // 1 or more
  std::string version_label;   // such as "stable"; not together with a version
};

// How much of one interaction class is wanted: 1 wanted, 0 neutral, -1 avoided, in [-2, 2].
struct ClassWeight {
  std::string interaction_class;
  float weight = 0;
};

// The weights at one frame of the leader.
struct WeightKeyframe {
  int frame = 0;
  std::vector<ClassWeight> weights;
};

// Where the follower is at the leader's first frame, in the leader's world: its root joint alone,
// or every joint in the order of the leader's joint_names.
using FollowerStart = std::variant<motion::Vec3, std::vector<motion::Vec3>>;

enum class Priority { kInteractive, kBulk };

// A follower to synthesise.
struct SynthesisRequest {
  ModelChoice model;
  // Metres, y up. Its joints are those of the model (GetModel lists them), in any order.
  motion::Clip leader;
  // Either weights for the whole clip, or keyframes for weights that change over time: linear
  // between keyframes, constant before the first and after the last.
  std::vector<ClassWeight> weights;
  std::vector<WeightKeyframe> keyframes;
  std::optional<FollowerStart> follower_start;
  // Horizontal direction from the leader to where the follower should be; y does not count. Absent:
  // towards follower_start; without one, where the leader's motion tells a model that has learned
  // it, or else where the leader's hips face in the first frame.
  std::optional<motion::Vec3> partner_direction;
  // Which answer of a model that samples (ModelInfo::samples): the same request with the same seed
  // has the same answer on the same server.
  uint64_t seed = 0;
  // How varied such a model's answers are over the seeds: 0 the typical answer, 1 as varied as
  // people are; at most RequestLimits::max_variety.
  float variety = 1;
  // Whether the follower is corrected so that it stands, keeps its feet still and its joints within
  // human ranges, and keeps out of the leader. Absent: the server's choice for the model; unless
  // it is told otherwise, that is where the model samples.
  std::optional<bool> clean_up;
  // Bulk work yields to interactive work, and waits its turn when the server is full.
  Priority priority = Priority::kInteractive;
  // Frames in one chunk of the reply. Absent: the server chooses.
  std::optional<int> chunk_frames;
  // Names the call in the server's log. Empty: the server makes one.
  std::string request_id;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_REQUEST_H_
