#ifndef DUET_CLIENT_LIVE_LIVE_RUN_H_
#define DUET_CLIENT_LIVE_LIVE_RUN_H_

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/client.h"
#include "client/live_session.h"
#include "client/request.h"
#include "model/motion/clip.h"
#include "model/motion/vec3.h"

namespace duet::client::live {

// The joints and the frame rate of all frames of a source.
struct LeaderFormat {
  std::vector<std::string> joint_names;  // every joint of the model, in any order
  double frame_rate_hz = 0;
};

// One frame of the leader.
struct LeaderFrame {
  // Counted from 0, in steps of 1 / frame_rate_hz. Sources without indices of their own count their
  // frames. Skipped indices mean lost frames. A repeated index is a frame that is too late.
  int index = 0;
  std::vector<motion::Vec3> positions;  // [joint_names]; metres, y up
};

// New labels, from the next frame on.
struct LabelCommand {
  std::vector<ClassWeight> weights;
  absl::Duration ease;  // until the new weights apply in full
};

using LeaderEvent = std::variant<LeaderFrame, LabelCommand>;

// What `duet live --from` reads: a file played in time, standard input, or a capture protocol.
//
// Threads: Open and Next are called by one thread. Stop may be called by any thread, at any time
//          and several times.
class LeaderSource {
 public:
  virtual ~LeaderSource() = default;

  // Blocks until the joints and the frame rate are known. Called once, before Next.
  //
  // Errors: INVALID_ARGUMENT for input that is malformed; UNAVAILABLE if Stop was called first;
  //         those of the system, such as a port that is in use.
  virtual absl::StatusOr<LeaderFormat> Open() = 0;

  // Blocks until the next event. Absent: the leader has ended, or Stop was called.
  virtual absl::StatusOr<std::optional<LeaderEvent>> Next() = 0;

  // Makes Open and Next return soon. Called when the user interrupts the program.
  virtual void Stop() = 0;

  // Whether frames arrive at their own time, so that the session has to keep up. Otherwise, each
  // frame is sent when the one before it was answered, and none is skipped.
  virtual bool IsLive() const { return true; }

  // What the user may want to know about how the source was read, one line each: joints that were
  // chosen, duplicates, gaps. Called after the last Next. Default: nothing.
  virtual std::vector<std::string> Notes() const { return {}; }
};

// A motion that is complete, played at its frame rate or as fast as the follower answers.
class ClipSource final : public LeaderSource {
 public:
  ClipSource(motion::Clip clip, bool realtime, std::vector<std::string> notes)
      : clip_(std::move(clip)), realtime_(realtime), notes_(std::move(notes)) {}

  absl::StatusOr<LeaderFormat> Open() override;
  absl::StatusOr<std::optional<LeaderEvent>> Next() override;
  void Stop() override;
  bool IsLive() const override { return realtime_; }
  std::vector<std::string> Notes() const override { return notes_; }

 private:
  bool WaitForFrame();

  const motion::Clip clip_;
  const bool realtime_;
  const std::vector<std::string> notes_;
  int next_ = 0;
  std::chrono::steady_clock::time_point begin_;
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stopped_ = false;
};

// What `duet live --to` writes to: a file, standard output, or a protocol of 3D programs.
//
// Threads: one call at a time, though not always from the same thread.
class FollowerSink {
 public:
  virtual ~FollowerSink() = default;

  // Called once, before Accept. The follower has the leader's joints and frame rate.
  virtual absl::Status Start(const LeaderFormat& format) = 0;

  // The next final frames, without gaps from frame 0 on.
  // Must return quickly: the session waits. An error ends the session.
  virtual absl::Status Accept(const LiveFrames& frames) = 0;

  // A leader frame that was sent. Default: nothing.
  virtual void AcceptLeader(const LeaderFrame& /*frame*/) {}

  // Called once, after the last frame; also if the session failed after Start. Returns what was
  // written, one line each for the summary: file names, or counts of packets. `info` is what the
  // server chose, empty if the session never began.
  virtual absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) = 0;
};

// A finished run.
struct LiveReport {
  LiveInfo info;
  LiveSummary summary;
  absl::Duration time;  // since the session began
  double frame_rate_hz = 0;
  std::vector<std::string> written;  // by the sinks
  std::vector<std::string> notes;    // of the source
};

// Runs a session from a source to sinks.
class LiveRun {
 public:
  // The source and the sinks outlive the run. `on_notice`, which may be empty, is called by one
  // thread at a time.
  LiveRun(LeaderSource* source, std::vector<FollowerSink*> sinks,
          std::function<void(const LiveNotice&)> on_notice)
      : source_(source), sinks_(std::move(sinks)), on_notice_(std::move(on_notice)) {}

  // Blocks until the leader has ended, or the source was stopped, and every frame that is due has
  // been answered. `request` lacks joints and frame rate. Writes what there is even if the session
  // fails.
  //
  // Errors: those of the source, the session and the sinks; the first of them.
  absl::StatusOr<LiveReport> Run(const Client& client, LiveRequest request);

 private:
  absl::Status RunSession(const Client& client, const LiveRequest& request);
  absl::Status Follow(LiveSession* session);
  absl::Status Send(LiveSession* session, const LeaderFrame& frame);
  void WaitForAnswers();
  void End();
  absl::Status Accept(const LiveFrames& frames);
  absl::Status FinishSinks();

  LeaderSource* const source_;
  const std::vector<FollowerSink*> sinks_;
  const std::function<void(const LiveNotice&)> on_notice_;
  int delay_frames_ = 0;
  LiveReport report_;

  std::mutex mutex_;  // of everything below, and of the sinks
  std::condition_variable answered_;
  absl::Time begin_;
  int sent_end_ = 0, answered_end_ = 0;
  bool ended_ = false;  // the session has ended
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_LIVE_RUN_H_
