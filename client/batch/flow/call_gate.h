#ifndef DUET_CLIENT_BATCH_FLOW_CALL_GATE_H_
#define DUET_CLIENT_BATCH_FLOW_CALL_GATE_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

#include "client/batch/flow/server_choice.h"

namespace duet::client::batch::flow {

// Makes threads wait until a ServerChoice allows a call.
//
// Threads: safe to call concurrently.
class CallGate {
 public:
  // `patience`: maximum time for which all servers may be away.
  CallGate(int servers, const Options& options, Duration patience)
      : servers_(servers, options), patience_(patience) {}

  // Waits until a call may start. nullopt after Stop, and when the patience is exceeded.
  std::optional<ServerChoice::Call> Start();
  void Finish(const ServerChoice::Call& call, CallEnd end, std::optional<Duration> delay);
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
  ServerChoice servers_;
  Duration patience_;
  std::optional<Time> away_since_;
  int64_t refusals_ = 0;
  bool lost_patience_ = false;
  bool stopped_ = false;
};

}  // namespace duet::client::batch::flow

#endif  // DUET_CLIENT_BATCH_FLOW_CALL_GATE_H_
