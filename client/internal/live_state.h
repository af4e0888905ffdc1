#ifndef DUET_CLIENT_INTERNAL_LIVE_STATE_H_
#define DUET_CLIENT_INTERNAL_LIVE_STATE_H_

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "client/live_session.h"
#include "duet/v1/live.pb.h"
#include "model/motion/joint_rotations.h"
#include "model/motion/vec3.h"

namespace duet::client::internal {

// The last frames of a motion that grows: consecutive frames, counted from its beginning.
class FrameLog {
 public:
  explicit FrameLog(int joint_count) : poses_(0, joint_count) {}

  // Kept are the frames [first(), end()).
  int first() const { return first_; }
  int end() const { return first_ + poses_.frame_count(); }

  // Requires whole frames.
  void Append(absl::Span<const motion::Vec3> frames) { poses_.Append(frames); }
  // [joints]
  absl::Span<const motion::Vec3> operator[](int frame) const { return poses_[frame - first_]; }
  // [count, joints]
  absl::Span<const motion::Vec3> Frames(int first, int count) const {
    return poses_.frames(first - first_, count);
  }

  // Keeps the frames from `frame` on, and perhaps some before it: it drops many at a time, because
  // that moves the others.
  void DropBefore(int frame) {
    const int dropped = frame - first_;
    if (dropped < kChunk || dropped > poses_.frame_count()) return;
    poses_.DropFront(dropped);
    first_ = frame;
  }

 private:
  static constexpr int kChunk = 256;

  int first_ = 0;
  motion::Poses poses_;
};

// The weights of a session over its frames: linear between keyframes, constant before the first and
// after the last. A class without a weight has weight 0.
class LabelTrack {
 public:
  // `keyframes`: by increasing frame.
  explicit LabelTrack(std::vector<WeightKeyframe> keyframes) : keyframes_(std::move(keyframes)) {}

  // Changes the weights linearly from those at `frame` to `weights` within `ease_frames` frames.
  // All later keyframes are dropped.
  void Change(int frame, const std::vector<ClassWeight>& weights, int ease_frames);

  // The keyframes that determine the weights from `frame` on.
  std::vector<WeightKeyframe> From(int frame) const;

 private:
  std::vector<ClassWeight> At(int frame) const;
  void Append(int frame, std::vector<ClassWeight> weights);

  std::vector<WeightKeyframe> keyframes_;
};

// Reads the joint rotations of a live session over all its streams. The wire has every quaternion
// with w >= 0; the caller gets each with the sign that is nearer to the frame before.
class LiveRotations {
 public:
  // wanted: whether the session asked for rotations. If not, a message that has some is an error.
  LiveRotations(bool wanted, int joint_count) : wanted_(wanted), joint_count_(joint_count) {}

  // The next message is the first one of a stream, which has the rig.
  void BeginStream() { has_rig_ = false; }

  // Returns the rotations of a message's frames from `known` on; absent if they are not wanted.
  // Errors: INVALID_ARGUMENT naming the field of the message.
  absl::StatusOr<std::optional<motion::JointRotations>> Read(const v1::FollowerFrames& frames,
                                                             int known);

 private:
  const bool wanted_;
  const int joint_count_;
  bool has_rig_ = false;  // of this stream
  std::vector<motion::RestJoint> rig_;
  std::vector<motion::UnitQuaternion> last_;  // of the last frame
};

// What an answer of the server means for the caller.
struct LiveAnswer {
  std::optional<LiveFrames> frames;
  std::optional<LiveNotice> notice;
};

// The state of a live session over all its streams: what was sent, what arrived, and what a stream
// has to begin with so that the session goes on where the last one broke.
//
// Threads: the owner locks. No method blocks.
class LiveState {
 public:
  // Errors: INVALID_ARGUMENT, naming the field, for values that the proto cannot represent.
  static absl::StatusOr<LiveState> Create(LiveRequest request);

  // Add frames or a change of labels, and return the message for the server. Send it if a stream is
  // open.
  absl::StatusOr<v1::SynthesizeLiveRequest> AddFrames(int first_frame,
                                                      absl::Span<const motion::Vec3> positions,
                                                      double capture_seconds);
  absl::StatusOr<v1::SynthesizeLiveRequest> ChangeLabels(const std::vector<ClassWeight>& weights,
                                                         absl::Duration ease);

  // Begins a stream, and returns its first messages: the start with the history and the leader's
  // frames since, then those frames that a start has no room for.
  std::deque<v1::SynthesizeLiveRequest> BeginStream();

  // Reads a message of the stream. INTERNAL if it violates the contract.
  absl::StatusOr<LiveAnswer> Accept(const v1::SynthesizeLiveResponse& response);

  // Whether follower frames are due for the added leader frames.
  bool IsDue() const { return delivered_ < leader_.end() - request_.delay_frames; }
  // Whether the session is over, once the leader has ended: the stream has its summary and no frame
  // is due, or every leader frame is answered.
  bool IsComplete() const { return (has_summary_ && !IsDue()) || delivered_ >= leader_.end(); }
  // Whether the stream has its header.
  bool is_open() const { return is_open_; }
  // Number of final frames so far.
  int delivered() const { return delivered_; }
  // Absent before the first header.
  const std::optional<LiveInfo>& info() const { return info_; }
  const LiveSummary& summary() const { return summary_; }

 private:
  LiveState(LiveRequest request, v1::LiveStart start);

  absl::Status CheckIndices(int first_frame, size_t points) const;
  void FillGap(int first_frame, absl::Span<const motion::Vec3> next, double capture_seconds);
  v1::LiveStart StartWithHistory(int answered, int first);
  // The index after the last leader frame in such a start.
  int StartEnd(int answered, int first) const;
  double CaptureSeconds(const v1::FollowerFrames& frames) const;
  absl::Status AcceptHeader(const v1::LiveHeader& header);
  absl::Status CheckFrames(const v1::FollowerFrames& frames) const;
  absl::StatusOr<LiveAnswer> AcceptFrames(const v1::FollowerFrames& frames);
  absl::StatusOr<LiveAnswer> AcceptNotice(const v1::LiveNotice& notice);
  void Prune();

  LiveRequest request_;
  v1::LiveStart start_;  // without history
  FrameLog leader_, follower_;
  LiveRotations rotations_;
  // Frame 0 of both, with rotations: a resumed session makes its rig from them. [joint_names]
  std::vector<motion::Vec3> rig_leader_, rig_follower_;
  std::vector<double> capture_seconds_;  // of the leader's frames from capture_first_ on
  int capture_first_ = 0;
  LabelTrack labels_;
  bool labels_changed_ = false;
  std::optional<LiveInfo> info_;
  LiveSummary summary_;
  int history_frames_ = 0;
  int delivered_ = 0;  // follower frames that the caller has
  // Of the stream in progress.
  bool is_open_ = false, has_summary_ = false;
  int next_frame_ = 0;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_LIVE_STATE_H_
