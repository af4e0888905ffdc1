#ifndef DUET_CLIENT_CAPTURE_CAPTURE_STREAM_H_
#define DUET_CLIENT_CAPTURE_CAPTURE_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "client/capture/frame_clock.h"
#include "client/capture/rate_estimate.h"
#include "client/capture/stream_reader.h"

namespace duet::client::capture {

// From datagrams to frames at a fixed rate: a reader, the measurement of the rate, and the clock.
// Like the clock, a pure function of what arrived and when.
//
// The first sender of a complete frame leads. Datagrams of others are ignored until it has been
// silent for kSenderSilence. Every sender has a reader of its own, so that two senders to one port
// are not mixed.
class CaptureStream {
 public:
  static constexpr double kSenderSilence = 2;  // seconds
  static constexpr int kMaxNotesOfAKind = 3;
  // Seconds after which a stream of datagrams without a frame is reported.
  static constexpr double kPatience = 1.5;

  // rate_hz: of the output; 0: measured in the first second, whose frames are not passed on.
  CaptureStream(std::function<std::unique_ptr<StreamReader>()> make_reader, double rate_hz);

  const std::vector<std::string>& joint_names() const { return joint_names_; }
  // 0 until it is known.
  double rate_hz() const { return rate_hz_; }

  // A datagram that arrived at `now`. `sender`: any text that is different for each sender.
  void Receive(absl::string_view datagram, absl::string_view sender, double now);
  // See FrameClock.
  std::optional<TimedFrame> Next(double now);
  double NextDue() const;

  int64_t frame_count() const { return frame_count_; }  // that arrived
  // What the user should know, in words: notes of the reader, events of the clock, and the kinds of
  // datagrams that were not understood. Each is returned once. Of events that a bad network repeats
  // all the time, the first kMaxNotesOfAKind are returned; Summary counts all of them.
  std::vector<std::string> TakeNotes();
  // Totals in words: "900 frames; 3 duplicates, ...".
  std::string Summary() const;

 private:
  static constexpr std::size_t kMaxKindsOfErrors = 8, kMaxSenders = 4;

  struct Sender {
    std::string address;
    std::unique_ptr<StreamReader> reader;
  };

  StreamReader& ReaderOf(absl::string_view sender);

  void ReceiveFrame(CaptureFrame frame, double now);
  void NoteError(const absl::Status& status);
  bool IsSilent() const { return first_heard_.has_value() && frame_count_ == 0; }
  void NoteSilence(double now);
  void NoteEvent(const ClockEvent& event);

  const std::function<std::unique_ptr<StreamReader>()> make_reader_;
  const std::vector<std::string> joint_names_;
  double rate_hz_;
  std::deque<Sender> senders_;  // the latest, by the time at which they began
  RateEstimate estimate_;
  std::optional<FrameClock> clock_;
  std::string leader_;  // a sender's address; empty: none
  double leader_heard_ = 0;
  bool other_senders_ = false;
  std::optional<double> first_heard_;  // when the first datagram arrived, until silence is reported
  int64_t datagram_count_ = 0;
  int64_t frame_count_ = 0, rejected_ = 0;
  std::set<std::string> errors_;  // that were noted
  std::map<ClockEvent::Kind, int> noted_events_;
  std::vector<std::string> notes_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_CAPTURE_STREAM_H_
