#ifndef DUET_CLIENT_CLIENT_H_
#define DUET_CLIENT_CLIENT_H_

#include <memory>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/live_session.h"
#include "client/options.h"
#include "client/request.h"
#include "client/result.h"

namespace duet::client {

// Calls a Duet server, which synthesizes the motion of one character (the follower) in response to
// the motion of another (the leader).
//
//   absl::StatusOr<Client> client = Client::Create({});
//   if (!client.ok()) return client.status();
//   SynthesisRequest request;
//   request.leader = leader;                        // metres, y up
//   request.weights = {{"kick", 1}, {"hug", 0.5}};
//   absl::StatusOr<SynthesisResult> result = client->Synthesize(request);
//   if (!result.ok()) return result.status();       // names every offending field
//   Use(result->pair.follower);
//
// Retries: UNAVAILABLE, broken streams, and RESOURCE_EXHAUSTED with RetryInfo for bulk calls; see
//          RetryOptions. The same request returns the same motion, so a broken stream is repeated
//          from its start.
// Errors:  the server's status; client/error_details.h reads its details. INTERNAL if the reply
//          violates the contract, UNAVAILABLE if it ended early.
// Threads: safe to call concurrently; copies share one connection.
class Client {
 public:
  // Returns INVALID_ARGUMENT if an option is invalid. Connects with the first call.
  static absl::StatusOr<Client> Create(const ClientOptions& options);

  explicit Client(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}

  // Lists every model version that the server serves, by name, newest version first.
  absl::StatusOr<std::vector<ModelInfo>> ListModels() const { return connection_->ListModels(); }
  // Gets one model version and the limits on requests to it.
  absl::StatusOr<ModelDetails> GetModel(const ModelChoice& choice = {}) const {
    return connection_->GetModel(choice);
  }
  // Blocks until the whole follower has arrived.
  absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request) const {
    return connection_->Synthesize(request, nullptr);
  }
  // Like Synthesize, but also passes each chunk to `on_chunk` when it arrives.
  absl::StatusOr<SynthesisResult> SynthesizeStreaming(const SynthesisRequest& request,
                                                      const ChunkCallback& on_chunk) const {
    return connection_->Synthesize(request, on_chunk);
  }
  // Starts a call and returns immediately. For callers that run several calls concurrently and
  // handle failures themselves: makes one attempt, whatever the retry options are.
  //
  // Calls `done` once, on the call's own thread. Destroying the last copy of a Client waits for
  // calls in progress, so `done` must not hold a copy.
  void SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) const {
    connection_->SynthesizeAsync(std::move(request), done);
  }
  // Begins a live session, in which the follower answers a leader who still moves
  // (client/live_session.h). Blocks until the server has accepted it.
  absl::StatusOr<std::unique_ptr<LiveSession>> StartLive(const LiveRequest& request,
                                                         LiveCallbacks callbacks) const {
    return connection_->StartLive(request, std::move(callbacks));
  }

 private:
  std::shared_ptr<Connection> connection_;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_CLIENT_H_
