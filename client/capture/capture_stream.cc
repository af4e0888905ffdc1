#include "client/capture/capture_stream.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/counted.h"

namespace duet::client::capture {
namespace {

constexpr std::size_t kMaxNotes = 64;

// An error without the numbers and values that differ from datagram to datagram.
std::string KindOf(absl::string_view message) {
  std::string kind(message.substr(0, message.find(", got ")));
  kind.erase(std::remove_if(kind.begin(), kind.end(),
                            [](unsigned char c) { return absl::ascii_isdigit(c); }),
             kind.end());
  return kind;
}

}  // namespace

CaptureStream::CaptureStream(std::function<std::unique_ptr<StreamReader>()> make_reader,
                             double rate_hz)
    : make_reader_(std::move(make_reader)),
      joint_names_(make_reader_()->joint_names()),
      rate_hz_(rate_hz) {}

void CaptureStream::Receive(absl::string_view datagram, absl::string_view sender, double now) {
  if (!leader_.empty() && leader_ != sender && now - leader_heard_ < kSenderSilence) {
    if (!std::exchange(other_senders_, true)) {
      notes_.emplace_back("a second sender sends to this port; its frames are ignored");
    }
    return;
  }
  if (++datagram_count_ == 1) first_heard_ = now;
  std::vector<CaptureFrame> frames;
  StreamReader& reader = ReaderOf(sender);
  NoteError(reader.Read(datagram, &frames));
  if (frames.empty()) return;
  leader_ = std::string(sender);
  leader_heard_ = now;
  std::vector<std::string> notes = reader.TakeNotes();
  std::move(notes.begin(), notes.end(), std::back_inserter(notes_));
  for (CaptureFrame& frame : frames) ReceiveFrame(std::move(frame), now);
}

StreamReader& CaptureStream::ReaderOf(absl::string_view sender) {
  for (const Sender& known : senders_) {
    if (known.address == sender) return *known.reader;
  }
  if (senders_.size() >= kMaxSenders) {
    senders_.erase(std::find_if(senders_.begin(), senders_.end(),
                                [this](const Sender& known) { return known.address != leader_; }));
  }
  senders_.push_back({std::string(sender), make_reader_()});
  return *senders_.back().reader;
}

void CaptureStream::ReceiveFrame(CaptureFrame frame, double now) {
  ++frame_count_;
  if (rate_hz_ <= 0) {
    estimate_.Add(frame.sender_seconds.value_or(now));
    rate_hz_ = estimate_.rate_hz().value_or(0);
  }
  if (rate_hz_ <= 0) return;
  if (!clock_.has_value()) {
    FrameClockOptions options;
    options.rate_hz = rate_hz_;
    clock_.emplace(options);
  }
  clock_->Receive(std::move(frame), now);
}

std::optional<TimedFrame> CaptureStream::Next(double now) {
  NoteSilence(now);
  return clock_.has_value() ? clock_->Next(now) : std::nullopt;
}

double CaptureStream::NextDue() const {
  if (IsSilent()) return *first_heard_ + kPatience;
  return clock_.has_value() ? clock_->NextDue() : std::numeric_limits<double>::infinity();
}

void CaptureStream::NoteError(const absl::Status& status) {
  if (status.ok()) return;
  ++rejected_;
  if (errors_.size() >= kMaxKindsOfErrors) return;
  if (errors_.insert(KindOf(status.message())).second) notes_.emplace_back(status.message());
}

// Datagrams arrive, but no frame.
void CaptureStream::NoteSilence(double now) {
  if (!IsSilent() || now < *first_heard_ + kPatience) return;
  first_heard_.reset();
  std::string missing;
  for (const Sender& sender : senders_) {
    if (missing.empty()) missing = sender.reader->Missing();
  }
  notes_.push_back(absl::StrCat("warning: ", base::Counted(datagram_count_, "datagram"),
                                " arrived in ", kPatience, " s, but no frame",
                                missing.empty() ? "" : "; ", missing));
}

void CaptureStream::NoteEvent(const ClockEvent& event) {
  // These are rare, and people see them.
  const bool is_long =
      event.kind == ClockEvent::Kind::kHeld || event.kind == ClockEvent::Kind::kResumed;
  const int count = is_long ? 0 : ++noted_events_[event.kind];
  if (count > kMaxNotesOfAKind) return;
  notes_.push_back(
      absl::StrCat(Describe(event), count == kMaxNotesOfAKind ? "; others are only counted" : ""));
}

std::vector<std::string> CaptureStream::TakeNotes() {
  if (clock_.has_value()) {
    for (const ClockEvent& event : clock_->TakeEvents()) NoteEvent(event);
  }
  std::vector<std::string> notes = std::exchange(notes_, {});
  if (notes.size() > kMaxNotes) notes.resize(kMaxNotes);
  return notes;
}

std::string CaptureStream::Summary() const {
  std::vector<std::string> parts;
  const auto add = [&parts](int64_t count, absl::string_view what) {
    if (count > 0) parts.push_back(absl::StrCat(count, " ", what));
  };
  const ClockCounts counts = clock_.has_value() ? clock_->counts() : ClockCounts();
  add(counts.duplicates, "duplicates");
  add(counts.late, "too late");
  add(counts.reordered, "put back into order");
  add(counts.jumps, "jumps of the sender's clock");
  add(counts.bridged_frames, "interpolated");
  add(counts.held_frames, "held");
  add(rejected_, "datagrams not understood");
  return absl::StrCat(base::Counted(frame_count_, "frame"), parts.empty() ? "" : "; ",
                      absl::StrJoin(parts, ", "));
}

}  // namespace duet::client::capture
