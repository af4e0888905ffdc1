#ifndef DUET_MODEL_ENGINE_CLIP_SYNTHESIS_H_
#define DUET_MODEL_ENGINE_CLIP_SYNTHESIS_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "model/body/grade.h"
#include "model/body/limbs.h"
#include "model/engine/label_track.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/engine/windows.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/solver/body_model.h"

namespace duet::engine {

// A validated request: what one call asks of a model.
struct ClipRequest {
  motion::Poses leader;      // the model's joint order, world metres, y up
  double frame_rate_hz = 0;  // the caller's
  LabelTrack labels;         // keyframes in the caller's frames
  std::optional<FollowerStart> start;
  // Horizontal, of any length above 0; see SynthesisWindow. If this and `start` are absent, it is
  // estimated from the leader's motion in the window, provided that the model can
  // (ModelDescription::partner_direction).
  std::optional<motion::Vec3> partner_direction;
  SynthesisOptions options = {};
  // Where joints of the follower must be, in the caller's frames and level world metres.
  motion::Pins pins = {};
};

// Turns a clip of any length into network windows and their results back into one motion.
//
// The leader is resampled to the model's rate and cut into overlapping windows no longer than the
// network was trained for, spread evenly. If the model accepts a follower start, each later window
// starts from the pose that the window before it reached. A model that samples continues from the
// first SettledOverlap frames that both windows share (SynthesisWindow::settled), because another
// sample would be another motion; each window has its own seed (WindowSeed). The next window
// replaces the other frames that they share, among them the lookahead
// (ModelDescription::lookahead_frames).
// Overlaps are cross-faded; this changes a settled frame by at most its difference from the
// network's answer. Frames at the caller's rate are returned as soon as no later window can change
// them.
//
//   ClipSynthesis clip(description, std::move(request));
//   while (clip.HasNextWindow()) {
//     SynthesisWindow window = clip.NextWindow();
//     ... result = synthesizer.Synthesize({&window}) ...
//     motion::Poses frames = clip.Accept(*result);   // may be empty, except for the last window
//   }
//
// Cost:    time linear in the clip's length; memory beyond the leader bounded by one window.
// Threads: not safe to call concurrently; no locks, no I/O.
class ClipSynthesis {
 public:
  ClipSynthesis(ModelDescription model, ClipRequest request);

  int window_count() const { return static_cast<int>(plan_.starts.size()); }
  int frame_count() const { return frame_count_; }
  const ClipRequest& request() const { return request_; }

  bool HasNextWindow() const { return state_.window_count() < window_count(); }
  // The next window to evaluate. Calling it twice before Accept gives the same window.
  SynthesisWindow NextWindow() const;
  // Takes the result of NextWindow, of as many frames, and returns the follower's frames
  // that became final, at the caller's rate, following those returned before. Over all windows:
  // exactly frame_count frames.
  motion::Poses Accept(const motion::Poses& follower);

  // The grade of all frames that were returned, at the caller's rate. Absent before the last window
  // was accepted, and if the model's skeleton lacks joints that the grade needs.
  std::optional<body::Grade> grade() const;

  // The distance that remains at each of ClipRequest::pins in the frames that were returned,
  // metres. Complete after the last window.
  const std::vector<float>& pin_distances() const { return pin_distances_; }

 private:
  // Where a frame of the caller lies among the model's, and the reverse.
  double ToModelFrame(double frame) const { return frame * model_frames_per_frame_; }
  double ToCallerFrame(int model_frame) const { return model_frame / model_frames_per_frame_; }

  // The model frame at which the next window begins. Requires HasNextWindow().
  int NextWindowStart() const {
    return plan_.starts[static_cast<std::size_t>(state_.window_count())];
  }
  // The model frame from which on the next window answers anew: SettledOverlap after its start;
  // with pins, after all frames that both share but the lookahead. Windows that are spread evenly
  // may share more frames; a network that must continue from most of a window makes a follower who
  // jumps after them.
  int SettledEnd() const;
  // The pins that concern a window from `first` on, in its frames.
  motion::Pins PinsOfWindow(int first) const;
  // Grades the frames that are returned, and measures their pins.
  void Measure(const motion::Poses& frames);
  motion::Poses TakeFinalFrames();
  // Makes next_frame_, a pose between two frames of the model, the same body again, which splines
  // change, with its feet between those of both frames; not near a pin, where the pin decides.
  // `at`: in the frames of state_.follower().
  void KeepBody(double at, motion::Poses* pose);
  bool IsNearPin(int frame) const;
  void DropFrames();
  // The leader in model frames [begin, end).
  motion::Poses LeaderAt(int begin, int end) const;

  ModelDescription model_;
  ClipRequest request_;
  CrossFade cross_fade_;
  int frame_count_;                // the caller's frames
  double model_frames_per_frame_;  // model rate / caller's rate
  WindowPlan plan_;                // in model frames
  WindowState state_;
  const body::Body body_;
  const bool cleans_up_;                     // see KeepBody
  std::vector<float> bone_lengths_;          // of the first frame that was returned
  std::optional<solver::BodyModel> person_;  // likewise; absent if the skeleton is none of a person
  int next_frame_ = 0;                       // the caller's next frame to hand out
  std::vector<float> pin_distances_;         // [pins]
  std::optional<body::PairMeter> meter_;     // absent if the skeleton lacks joints
  body::GradeSum grade_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CLIP_SYNTHESIS_H_
