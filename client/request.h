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

// Selects a model version. Default: the newest version of the server's default model.
struct ModelChoice {
  std::string name;            // empty: the server's default model
  std::optional<int> version;  // 1 or more
  std::string version_label;   // such as "stable"; mutually exclusive with `version`
};

// The weight of one interaction class, in [-2, 2]: 1 requests the class, 0 is neutral, -1 avoids
// it.
struct ClassWeight {
  std::string interaction_class;
  float weight = 0;
};

// The weights at one frame of the leader.
struct WeightKeyframe {
  int frame = 0;
  std::vector<ClassWeight> weights;
};

// The follower at the leader's first frame, in the leader's world: the position of its root joint,
// or the positions of every joint in the order of the leader's joint_names.
using FollowerStart = std::variant<motion::Vec3, std::vector<motion::Vec3>>;

enum class Priority { kInteractive, kBulk };

// How a follower reacts, beyond model, leader, weights and start. Every field has a default.
struct ReactionOptions {
  // Direction from the leader to the follower; y is ignored. Absent: towards follower_start.
  // Without follower_start, models trained to estimate the direction derive it from the leader's
  // motion; all others use the direction in which the leader's hips face in the first frame.
  std::optional<motion::Vec3> partner_direction;
  // The true vertical of the leader's world, for motion from a tilted camera: of any length, less
  // than 45 degrees from +y. The server levels the whole request and returns the follower tilted
  // like the leader. Absent: +y.
  std::optional<motion::Vec3> up;
  // Seed of the random sample that a sampling model draws (ModelInfo::samples). On the same server,
  // the same request with the same seed returns the same motion. Absent: derived from the leader in
  // clips (SynthesisResult::seed), a typical one in live sessions.
  std::optional<uint64_t> seed;
  // How much the results of a sampling model vary between seeds: 0 returns the typical motion, 1
  // varies as much as the captured motion does. At most RequestLimits::max_variety.
  float variety = 1;
  // How much the leader's motion moves the follower: 0 not at all, 1 as the model has learnt, at
  // most 2. Other values than 1 take longer.
  float reaction = 1;
  // Number of samples that a sampling model draws for each window; the server returns the best one
  // (SynthesisResult::grade). More samples take longer. At most RequestLimits::max_candidates.
  int candidates = 1;
  // Whether the server cleans up the follower: keeps it upright and on the floor, removes foot
  // sliding, keeps joints within human ranges, and resolves overlaps with the leader. Absent: the
  // server's setting. By default, the server cleans up only the results of sampling models.
  std::optional<bool> clean_up;
  // ID of the call in the server's log, of 1 to 128 printable ASCII characters without spaces.
  // Empty: the server generates one.
  std::string request_id;
};

// Where a joint of the follower must be in one frame of the leader. The server moves the limb or
// the body there, eased over the neighbouring frames; SynthesisResult::constraint_metres has the
// distance that remains.
struct JointConstraint {
  std::string joint;  // one of the leader's joint_names
  int frame = 0;
  motion::Vec3 position;  // in the leader's world
  // Share of the distance that may remain, in [0, 1]. 1 moves nothing, but candidates that are near
  // are still preferred.
  float softness = 0;
};

// What a caller chooses of the answer to a whole clip. Every field has a default.
// docs/guides/add_a_request_field.md describes how to add a field.
struct SynthesisOptions : ReactionOptions {
  // Whether the answer has joint rotations beside the positions, for engines
  // (SynthesisResult::rotations, FollowerChunk::rotations).
  bool rotations = false;
  // Bulk calls yield to interactive calls, and are retried if the server is full.
  Priority priority = Priority::kInteractive;
  // Maximum number of frames in one chunk of the reply. Absent: the server's default.
  std::optional<int> chunk_frames;
  // At most RequestLimits::max_constraints; each joint at most once in a frame.
  std::vector<JointConstraint> constraints;
};

// A request to synthesize a follower. The options are a base, so that they can be collected and
// assigned as one value while each remains a field of the request.
struct SynthesisRequest : SynthesisOptions {
  ModelChoice model;
  // Metres, y up. Has every joint of the model (ModelInfo::joint_names), in any order.
  motion::Clip leader;
  // Either `weights` for the whole clip, or `keyframes` for weights that change over time: linear
  // between keyframes, constant before the first and after the last.
  std::vector<ClassWeight> weights;
  std::vector<WeightKeyframe> keyframes;
  std::optional<FollowerStart> follower_start;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_REQUEST_H_
