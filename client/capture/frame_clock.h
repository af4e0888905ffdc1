#ifndef DUET_CLIENT_CAPTURE_FRAME_CLOCK_H_
#define DUET_CLIENT_CAPTURE_FRAME_CLOCK_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/capture/stream_reader.h"
#include "model/motion/vec3.h"

namespace duet::client::capture {

struct FrameClockOptions {
  double rate_hz = 30;            // of the output
  double reorder_seconds = 0.03;  // how long a missing frame is waited for once a later one is here
  double bridge_seconds = 0.25;   // gaps up to this length are interpolated, longer ones are held
};

// One frame of the output.
struct TimedFrame {
  enum class Source { kCaptured, kInterpolated, kHeld };
  int index = 0;               // from 0, without gaps
  double capture_seconds = 0;  // on the receiver's clock, as well as it is known
  Source source = Source::kCaptured;
  std::vector<motion::Vec3> positions;  // [joints]
};

// What the clock did about a stream that is not perfect.
struct ClockEvent {
  enum class Kind {
    kDuplicate,   // frames that had arrived before, dropped
    kLate,        // frames that arrived after a later one had been used, dropped
    kReordered,   // frames that arrived after a later one, and were still of use
    kBridged,     // a gap that was interpolated
    kHeld,        // a gap in which the pose was held
    kResumed,     // the end of a gap in which the pose was held
    kClockJumped  // the sender's clock jumped, and was set anew
  };
  Kind kind = Kind::kDuplicate;
  int frame = 0;       // the next frame of the output
  double seconds = 0;  // the length of a gap, or of a jump
};
// "gap of 0.12 s before frame 81 interpolated".
std::string Describe(const ClockEvent& event);

struct ClockCounts {
  int64_t received = 0, duplicates = 0, late = 0, reordered = 0, jumps = 0;
  int64_t bridged_frames = 0, held_frames = 0;  // of the output
};

// Puts the frames of a capture stream into order, at a fixed rate.
//
// A pure function of what arrived and when: it has no thread and reads no clock, and times must not
// decrease. A frame is passed on as soon as it arrives if it is the next one. After lost
// frames, it waits `reorder_seconds` for them, and then interpolates.
//
// Clocks: the frames' order and distances are those of the sender's times. The smallest delay
// between the two clocks in the last seconds tells when a frame is missing. A frame without a time
// has the time of its arrival. The output's phase follows the sender slowly, so that two rates that
// are nearly equal do not drift apart.
class FrameClock {
 public:
  explicit FrameClock(const FrameClockOptions& options);

  // A frame that arrived at `now`, in seconds of the receiver's clock.
  void Receive(CaptureFrame frame, double now);
  // The next frame of the output, if it is due at `now`.
  std::optional<TimedFrame> Next(double now);
  // The earliest time at which Next may return a frame if nothing arrives; infinite if never.
  double NextDue() const;

  // The latest events, at most kMaxEvents; each is returned once.
  static constexpr std::size_t kMaxEvents = 64;
  std::vector<ClockEvent> TakeEvents();
  const ClockCounts& counts() const { return counts_; }

 private:
  // Frames that wait for the output: those of the times that it interpolates between.
  static constexpr std::size_t kMaxWaiting = 256;
  static constexpr std::size_t kIntervals = 15;
  static constexpr std::size_t kDelays = 10;  // one for each second

  // A frame on the clock's timeline: the sender's time, shifted where that clock jumped.
  struct Sample {
    double seconds = 0;
    double arrival = 0;
    std::vector<motion::Vec3> positions;
  };

  bool IsKnown(double seconds) const;
  double ToTimeline(const CaptureFrame& frame, double now);
  void Insert(Sample sample);
  void UpdateDelay(double delay, double now);
  double Delay() const;
  double SenderPeriod() const;
  double DueTime() const { return origin_ + next_ / options_.rate_hz; }
  bool IsNext(double seconds) const;
  TimedFrame Emit(TimedFrame::Source source, std::vector<motion::Vec3> positions);
  TimedFrame EmitWaiting();
  TimedFrame Hold(double gap);
  void EndHold();
  std::optional<TimedFrame> FillGap(double now);
  std::optional<TimedFrame> HoldSilence(double now);
  void Report(ClockEvent::Kind kind, double seconds = 0);

  const FrameClockOptions options_;
  double period_ = 0;       // of the output
  bool has_times_ = false;  // the last frame had a time
  bool started_ = false;
  bool in_hold_ = false, in_bridge_ = false;
  double held_from_ = 0, held_until_ = 0;
  double origin_ = 0;             // the time of frame 0 of the output, on the timeline
  int next_ = 0;                  // the next frame of the output
  double shift_ = 0;              // from the sender's clock to the timeline
  double newest_ = 0;             // the latest time that arrived
  int stale_ = 0;                 // frames in succession that did not advance
  Sample left_;                   // the last sample at or before the next frame
  std::deque<Sample> waiting_;    // later samples, in order
  std::deque<double> recent_;     // times that arrived lately, for duplicates
  std::deque<double> intervals_;  // between the sender's frames
  std::deque<std::pair<int64_t, double>> delays_;  // second, and the smallest delay in it
  std::vector<ClockEvent> events_;
  ClockCounts counts_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_FRAME_CLOCK_H_
