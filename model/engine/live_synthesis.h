#ifndef DUET_MODEL_ENGINE_LIVE_SYNTHESIS_H_
#define DUET_MODEL_ENGINE_LIVE_SYNTHESIS_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/engine/label_track.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/solver/body_model.h"

namespace duet::engine {

// When a live session evaluates the network, and what an evaluation reads. A pure function of the
// model, the caller's frame rate and the delay, so that a resumed session evaluates at the same
// frames.
class LiveTiming {
 public:
  // Requires a positive rate.
  LiveTiming(const ModelDescription& model, double frame_rate_hz, int delay_frames);

  double ToModelFrame(int frame) const { return frame * model_frames_per_frame_; }
  double ToCallerFrame(int model_frame) const { return model_frame / model_frames_per_frame_; }
  // The last model frame that is not after a frame of the caller.
  int ModelFrameAt(int frame) const;

  int delay_frames() const { return delay_frames_; }
  // Model frames in one window: of the follower's past that it continues from, of what was sent and
  // is made anew, and of the future.
  int past_frames() const { return past_; }
  int remade_frames() const { return remade_; }
  int future_frames() const { return future_; }
  // Number of the caller's last frames that an evaluation may read, of both motions.
  int history_frames() const;

  // Whether the network is evaluated when leader frame `frame` has arrived. The first frame that
  // has an answer (delay_frames) is such a frame.
  bool IsEvaluation(int frame) const;
  // The first evaluation after, and the last one not after, a leader frame. Requires the latter to
  // be at least delay_frames.
  int EvaluationAfter(int frame) const;
  int EvaluationNotAfter(int frame) const;

 private:
  int delay_frames_;
  double model_frames_per_frame_;  // model rate / caller's rate
  int model_frames_between_;       // evaluations
  int past_, remade_, future_;
};

// Returns what a leader is taken to do after its last known frame, while the true motion is still
// unknown: it comes to rest, with constant limb lengths. Live synthesis and its training share it.
//
// Shapes: known [frames, joints], at least one frame; seconds [n], each above 0, from the last
//         known frame on; returns [n, joints].
motion::Poses ComeToRest(const motion::Skeleton& skeleton, const motion::Poses& known,
                         double frame_rate_hz, absl::Span<const double> seconds);

// A validated request for a live session.
struct LiveRequest {
  double frame_rate_hz = 0;  // the caller's
  int delay_frames = 0;      // leader frames to wait for before a frame is answered
  LabelTrack labels;         // keyframes in the caller's frames
  std::optional<FollowerStart> start;
  std::optional<motion::Vec3> partner_direction;  // see ClipRequest; used for the first window
  SynthesisOptions options = {};
  // A resumed session: both motions from frame `first_frame` on, in the model's joint order, world
  // metres, y up. `follower` has at least one frame and no more than the leader makes final. Empty,
  // with first_frame 0, for a new session.
  int first_frame = 0;
  motion::Poses leader = {};
  motion::Poses follower = {};
};

// A run of the caller's frames.
struct LiveFrames {
  int first = 0;
  motion::Poses poses;  // [n, joints]
};

// Returns true if the model can answer live: it continues from settled frames.
bool AnswersLive(const ModelDescription& model);

// Answers a leader while it still moves.
//
// Follower frame n is final when leader frame n + delay is there. At certain leader frames
// (LiveTiming) the network plans the follower's next frames from the last second of both motions.
// It sees the leader's future as a motion that comes to rest, and labels that stay as they are at
// the first frame that the plan may change. Final frames are taken from the newest plan. If leader
// frames arrive faster than plans are made, the due frames come from the plan that is held, and
// only the newest evaluation is made.
//
//   LiveSynthesis live(description, request);
//   live.AddLeader(frames);                       // as they arrive
//   for (;;) {
//     LiveFrames due = live.TakeDue();  // one frame
//     if (due.poses.frame_count() > 0) { ... send; live.Settle(as sent) ... }
//     else if (live.NeedsWindow()) { ... live.Accept(result of live.NextWindow()) ... }
//     else break;
//   }
//
// The state is a function of the last history_frames() frames of both motions, seed and labels: a
// session that is resumed from them continues with the same frames, bit for bit, if no evaluation
// was skipped.
//
// Cost:    memory bounded by the history, besides leader frames that were not answered.
// Threads: not safe to call concurrently; no locks, no I/O.
class LiveSynthesis {
 public:
  // Requires AnswersLive(model).
  LiveSynthesis(ModelDescription model, LiveRequest request);

  int history_frames() const { return timing_.history_frames(); }
  int delay_frames() const { return timing_.delay_frames(); }
  // The next leader frame to add, and the next follower frame that is not final.
  int next_leader_frame() const { return leader_begin_ + leader_.frame_count(); }
  int next_follower_frame() const { return follower_begin_ + follower_.frame_count(); }
  // The newest leader frame, [joints]; empty before the first.
  absl::Span<const motion::Vec3> newest_leader() const {
    return leader_.empty() ? absl::Span<const motion::Vec3>() : leader_[leader_.frame_count() - 1];
  }

  // Adds leader frames that follow those added before. Not after EndLeader.
  void AddLeader(const motion::Poses& frames);
  // The leader has ended: the frames that wait for later leader frames are due.
  void EndLeader() { ended_ = true; }
  // Changes the labels from `frame` on, which is not final; see LabelTrack::Change.
  void ChangeLabels(int frame, int ease_frames, const std::vector<float>& weights);

  // Takes the next frame that is due and that the plan answers; no frame if there is none. Settle
  // must follow if there is one. A frame depends on the frame before it as the caller got that, so
  // several at a time would be other frames.
  LiveFrames TakeDue() const;
  // Makes the frame that TakeDue returned final, as the caller gets it: rounded to its units.
  void Settle(const motion::Poses& frame);

  // Whether a window is to be evaluated. Requires that no frames are due from the plan held.
  bool NeedsWindow() const;
  // The window to evaluate. Calling it twice before Accept gives the same window, unless leader
  // frames or labels were added in between.
  SynthesisWindow NextWindow();
  // Takes the result of the last NextWindow, of as many frames.
  void Accept(const motion::Poses& follower);

  // The next frames that are not final, at most `count`. Provisional: as planned, and beyond the
  // plan a motion that comes to rest.
  LiveFrames Plan(int count) const;
  // True if every leader frame was answered.
  bool done() const { return ended_ && next_follower_frame() >= next_leader_frame(); }
  // Number of final frames that were answered from an older plan because an evaluation was skipped.
  int skipped_frames() const { return skipped_frames_; }

 private:
  // The follower frames before this one are due.
  int DueEnd() const;
  // The leader frame at whose arrival the next evaluation is made. Absent: none is to be made.
  std::optional<int> NextEvaluation() const;
  // The first evaluation of this object, and one after another.
  std::optional<int> FirstEvaluation(int newest) const;
  std::optional<int> FurtherEvaluation(int newest) const;
  // The first frame that the plan of an evaluation may change.
  int JoinFrame(int evaluation) const;
  // The plan held answers the frames before this one.
  int PlannedEnd() const;
  // A frame of the plan held, without and with what remains of the plan before it.
  void SamplePlan(int frame, absl::Span<motion::Vec3> pose) const;
  void SampleJoined(int frame, motion::Poses* pose) const;
  LiveFrames Sample(int count) const;

  std::vector<float> WindowLabels(int begin, int frames, int join) const;
  motion::Poses WindowLeader(int begin, int frames, int newest, int* hidden) const;
  motion::Poses WindowFollower(int begin, int end, int join) const;
  void KeepOffset();
  void DropOldFrames();

  ModelDescription model_;
  LiveRequest request_;
  LiveTiming timing_;
  body::Body body_;
  bool cleans_up_;  // whether frames are bodies; see SynthesisOptions::clean_up
  // Frames before this one are answered evaluation by evaluation: those of a resumed session.
  int replay_end_;

  motion::Poses leader_, follower_;  // at the caller's rate
  int leader_begin_, follower_begin_;
  // No plan changes earlier frames: 0, or the second frame of the history, because a plan continues
  // from at least one frame.
  int first_join_ = 0;
  bool ended_ = false;

  std::optional<int> evaluation_;  // of the plan held
  motion::Poses plan_;             // at the model's rate
  int plan_begin_ = 0;
  int join_frame_ = 0;  // the first frame that the plan may change
  // Of the plan; the person is absent if the skeleton is none of a person.
  std::vector<float> bone_lengths_;
  std::optional<solver::BodyModel> person_;
  // From the plan to the frame before join_frame_, as it was sent: [joints], empty without such a
  // frame. It is added to the plan with a weight that falls to 0.
  std::vector<motion::Vec3> offset_;

  std::optional<int> pending_;  // the evaluation of NextWindow
  int window_begin_ = 0;        // the model frame at which its window begins
  int skipped_frames_ = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LIVE_SYNTHESIS_H_
