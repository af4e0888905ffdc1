#ifndef DUET_CLIENT_BATCH_FLOW_CALL_GATE_H_
#define DUET_CLIENT_BATCH_FLOW_CALL_GATE_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

namespace duet::client::batch::flow {

// How many concurrent calls the server gets, and when. In CallWindow, time is a parameter, so that
// tests can simulate any sequence of events.

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

// The result of a call that matters to the flow.
enum class CallEnd {
  kAnswered,  // also if the request was rejected permanently
  kRefused,   // the server is full
  kAway,      // no answer, or the server is loading or draining
};

struct Options {
  int max_in_flight = 64;
  Duration first_backoff = std::chrono::milliseconds(50);
  Duration longest_backoff = std::chrono::seconds(5);
};

// The window of calls in flight. Threads: the caller locks.
//
// Grows by one for each answer until the first refusal, then by one for each full window of
// answers. It is halved when the server is full, once for all calls in flight at that time, and set
// to one when the server is away. After a refusal, no call starts before the delay that the server
// states. While the server is away, single calls probe it at increasing intervals. Source: TCP
// Reno's slow start and congestion avoidance (Jacobson 1988).
class CallWindow {
 public:
  explicit CallWindow(const Options& options) : options_(options) {}

  // Whether a call may start. If only the time prevents it, `opens` returns when.
  bool MayStart(Time now) const { return in_flight_ < limit() && now >= opens_; }
  Time opens() const { return opens_; }
  int limit() const { return static_cast<int>(window_); }
  int in_flight() const { return in_flight_; }
  bool away() const { return failures_ > 0; }

  // A call starts. Pass the result to Finish.
  int64_t Start();
  // `delay`: the retry delay that the server states.
  void Finish(int64_t call, CallEnd end, std::optional<Duration> delay, Time now);

 private:
  void Close(Duration wait, Time now);

  Options options_;
  double window_ = 2;
  bool slow_start_ = true;
  int in_flight_ = 0;
  int64_t started_ = 0;
  int64_t counted_from_ = 0;  // calls from this number on count against the window
  int failures_ = 0;          // calls in a row to a server that was away
  Time opens_{};
};

// Makes threads wait until a CallWindow allows a call.
//
// Threads: safe to call concurrently.
class CallGate {
 public:
  // `patience`: maximum time for which the server may be away.
  CallGate(const Options& options, Duration patience) : window_(options), patience_(patience) {}

  // Waits until a call may start, and returns its number. nullopt after Stop, and when the patience
  // is exceeded.
  std::optional<int64_t> Start();
  void Finish(int64_t call, CallEnd end, std::optional<Duration> delay);
  // No more calls start; calls in progress continue.
  void Stop();

  struct State {
    int in_flight = 0;
    int limit = 0;
    int64_t refusals = 0;
    bool lost_patience = false;
  };
  State state() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  CallWindow window_;
  Duration patience_;
  std::optional<Time> away_since_;
  int64_t refusals_ = 0;
  bool lost_patience_ = false;
  bool stopped_ = false;
};

}  // namespace duet::client::batch::flow

#endif  // DUET_CLIENT_BATCH_FLOW_CALL_GATE_H_
