#ifndef DUET_CLIENT_LIVE_SESSION_H_
#define DUET_CLIENT_LIVE_SESSION_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "absl/types/span.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/joint_rotations.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

// Live sessions: the follower answers a leader who still moves.

namespace duet::client {

// What a live session begins with. Of the options, `up` and the others mean what they mean in a
// SynthesisRequest.
struct LiveRequest : ReactionOptions {
  ModelChoice model;
  // Of every frame of the session. Has every joint of the model, in any order.
  std::vector<std::string> joint_names;
  double frame_rate_hz = 0;
  // Either `weights` from the first frame on, or `keyframes` for weights that change over time.
  // LiveSession::ChangeLabels replaces both.
  std::vector<ClassWeight> weights;
  std::vector<WeightKeyframe> keyframes;
  std::optional<FollowerStart> follower_start;
  // Number of later leader frames that the server waits for before it answers a frame, 0 to 10. A
  // few frames of delay give a better reaction.
  int delay_frames = 0;
  // Number of provisional frames beyond the final ones, 0 to 30 (LiveFrames::plan).
  int plan_frames = 0;
  // Whether the final frames have joint rotations beside the positions, for engines.
  bool rotations = false;
};

// Consecutive frames of the follower. Frame n belongs to the same instant as leader frame n.
struct LiveFrames {
  int first_frame = 0;
  motion::Poses poses;  // [frames, joint_names]; metres, y up; final
  // What the server expects of the frames after these, up to LiveRequest::plan_frames. Provisional:
  // each plan replaces the one before it.
  motion::Poses plan;
  // The rotations of `poses`, if the request asks for them. The rig is the same in every message.
  std::optional<motion::JointRotations> rotations;
  // The newest leader frame that the server had, and the capture time that was sent with it.
  int leader_frame = 0;
  double capture_seconds = 0;
  // From the arrival of that leader frame at the server to the answer.
  absl::Duration server_time;
};

// Something that happened to a session and that the user may want to know.
struct LiveNotice {
  enum class Kind {
    kGapFilled,    // leader frames were missing, and were interpolated
    kLate,         // leader frames were dropped, because newer ones had been answered
    kSkipped,      // the server could not keep up: these frames are from an older plan
    kDraining,     // the server shuts down; the session moves to another one
    kInterrupted,  // the connection broke; the session tries to resume
    kResumed,      // the session goes on, on this server or another
  };
  Kind kind = Kind::kGapFilled;
  FrameRun frames;      // of the first three kinds
  std::string message;  // why, of kInterrupted
};

// What the server chose for a session, or was asked for.
struct LiveInfo {
  std::string model_name;
  int model_version = 0;
  std::vector<std::string> interaction_classes;
  uint64_t seed = 0;
  float variety = 0;
  int candidates = 1;
  bool cleaned_up = false;
  int delay_frames = 0;
  std::string request_id;  // of the first stream, in the server's log
};

// Totals of a session.
struct LiveSummary {
  int leader_frames = 0;    // number of leader frames, interpolated ones included
  int follower_frames = 0;  // number of final frames
  int gap_frames = 0;       // leader frames that were interpolated
  int late_frames = 0;      // leader frames that were dropped
  int skipped_frames = 0;   // follower frames from an older plan
  int resumed = 0;          // number of times that the session was resumed
};

// Functions that a session calls, one at a time, on a thread of its own. They should return
// quickly, and must not call Finish or destroy the session; they may call Send and ChangeLabels.
struct LiveCallbacks {
  // Required. Every final frame exactly once, in order, whatever happens to the connection. A
  // status that is not OK ends the session with that status.
  std::function<absl::Status(const LiveFrames&)> on_frames;
  // Optional.
  std::function<void(const LiveNotice&)> on_notice;
  // Optional. Called last, when the session has ended: with OK after Finish, otherwise with the
  // reason, which Send and Finish return too.
  std::function<void(const absl::Status&)> on_end;
};

// A session that Client::StartLive began.
//
//   LiveRequest request;
//   request.joint_names = joints;
//   request.frame_rate_hz = 60;
//   request.weights = {{"hug", 1}};
//   auto session = client->StartLive(request, {[&](const LiveFrames& frames) {
//     Show(frames.poses);
//     return absl::OkStatus();
//   }});
//   if (!session.ok()) return session.status();
//   for (int n = 0; captures.Next(&pose); ++n) {
//     absl::Status sent = (*session)->Send(n, pose, captures.Seconds());
//     if (!sent.ok()) return sent;
//   }
//   absl::StatusOr<LiveSummary> summary = (*session)->Finish();
//
// Interruptions: a session survives a broken connection, a server that shuts down, and one that
//          stops answering. It opens another stream, on the next server behind the address, with
//          the last frames of both motions; frames that were sent meanwhile follow. It gives up
//          when no server could be reached for ClientOptions::wait, or when reachable servers
//          refused it for ClientOptions::deadline. The deadline does not limit the session itself.
// Errors:  the server's status. INTERNAL if an answer violates the contract; ABORTED if the model
//          version of an interrupted session is no longer served.
// Threads: Send and ChangeLabels may be called by any thread, also by a callback. Call Finish once.
class LiveSession {
 public:
  // Ends the session at once, if Finish was not called. No callback runs afterwards.
  virtual ~LiveSession() = default;

  // What the server chose.
  virtual const LiveInfo& info() const = 0;

  // Sends consecutive leader frames. Does not block.
  //
  // Shapes:  positions [frames >= 1, joint_names], row-major. Units: metres, y up.
  // Indices: `first_frame` counts from 0. Frames that were sent before are dropped; skipped frames
  //          are interpolated, at most two seconds of them (LiveNotice).
  // `capture_seconds`: when the last frame was captured, on any clock (LiveFrames).
  // Errors:  INVALID_ARGUMENT for an index or a number of positions that cannot be; the session's
  //          own status if it has failed; FAILED_PRECONDITION after Finish; RESOURCE_EXHAUSTED if
  //          more than two minutes of frames wait for an answer.
  virtual absl::Status Send(int first_frame, absl::Span<const motion::Vec3> positions,
                            double capture_seconds) = 0;

  // Changes the labels from the first follower frame on that the frames sent so far do not make
  // final. The weights change linearly within `ease`, at most 10 seconds.
  virtual absl::Status ChangeLabels(const std::vector<ClassWeight>& weights,
                                    absl::Duration ease) = 0;

  // Ends the leader's motion, waits for the frames that are due, and returns the totals.
  virtual absl::StatusOr<LiveSummary> Finish() = 0;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_LIVE_SESSION_H_
