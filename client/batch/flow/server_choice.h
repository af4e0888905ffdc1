#ifndef DUET_CLIENT_BATCH_FLOW_SERVER_CHOICE_H_
#define DUET_CLIENT_BATCH_FLOW_SERVER_CHOICE_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace duet::client::batch::flow {

// How many calls a server gets at once, and when. Decides and measures nothing: time comes from
// outside, so that tests play any course of events. No locks: the caller's.

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

// How a call ended, as far as the flow is concerned.
enum class CallEnd {
  kAnswered,  // also when the request was refused for good
  kRefused,   // the server is full
  kAway,      // nobody answers, or the server is loading or draining
};

struct Options {
  int max_in_flight = 64;  // of one server
  Duration first_backoff = std::chrono::milliseconds(50);
  Duration longest_backoff = std::chrono::seconds(5);
};

// The window of calls in flight at one server.
//
// Grows by one for each answer until the first refusal, then by one for each full window of
// answers; halves when the server is full, once for all calls that were under way then; falls to
// one when the server is away. After a refusal no call starts before the server's own delay is
// over; while it is away, one call at a time asks after it, less and less often. Source: TCP Reno's
// slow start and congestion avoidance (Jacobson 1988).
class CallWindow {
 public:
  explicit CallWindow(const Options& options) : options_(options) {}

  // Whether a call may start. If not for the time alone, `opens` tells when.
  bool MayStart(Time now) const { return in_flight_ < limit() && now >= opens_; }
  Time opens() const { return opens_; }
  int limit() const { return static_cast<int>(window_); }
  int in_flight() const { return in_flight_; }
  bool away() const { return failures_ > 0; }

  // A call starts; returns what Finish wants.
  int64_t Start();
  // `delay`: when the server wants to be asked again, from now on.
  void Finish(int64_t call, CallEnd end, std::optional<Duration> delay, Time now);

 private:
  void Close(Duration wait, Time now);

  Options options_;
  double window_ = 2;
  bool slow_start_ = true;
  int in_flight_ = 0;
  int64_t started_ = 0;
  int64_t counted_from_ = 0;  // calls from here on count against the window
  int failures_ = 0;          // calls in a row to a server that was away
  Time opens_{};
};

// Several servers: each call goes to the one with the most room.
class ServerChoice {
 public:
  ServerChoice(int servers, const Options& options)
      : windows_(static_cast<size_t>(servers), CallWindow(options)) {}

  struct Call {
    int server = 0;
    int64_t number = 0;
  };
  // Nothing while no server may have another call.
  std::optional<Call> Start(Time now);
  void Finish(const Call& call, CallEnd end, std::optional<Duration> delay, Time now);

  // When Start is worth another look although no call ends; nothing if only an end helps.
  std::optional<Time> NextOpening(Time now) const;
  int in_flight() const;
  int limit() const;
  // Whether a window is not full, at whatever time it may have a call.
  bool HasRoom() const;
  bool all_away() const;

 private:
  std::vector<CallWindow> windows_;
  size_t last_ = 0;  // turns are taken among equals
};

}  // namespace duet::client::batch::flow

#endif  // DUET_CLIENT_BATCH_FLOW_SERVER_CHOICE_H_
