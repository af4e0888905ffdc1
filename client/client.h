#ifndef DUET_CLIENT_CLIENT_H_
#define DUET_CLIENT_CLIENT_H_

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/options.h"
#include "client/request.h"
#include "client/result.h"

namespace duet::client {

// Asks a Duet server to answer one character's motion with another's.
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
// Retries: UNAVAILABLE, streams that break, and RESOURCE_EXHAUSTED for bulk work when the server
//          says when to come back; see RetryOptions. The same request gives the same motion, so a
//          broken stream is run again from its start.
// Errors:  the server's status; client/error_details.h reads its details. INTERNAL when the reply
//          breaks the contract, UNAVAILABLE when it merely ended early.
// Threads: safe to call concurrently; copies share one connection.
class Client {
 public:
  // INVALID_ARGUMENT when an option makes no sense. Does not connect yet.
  static absl::StatusOr<Client> Create(const ClientOptions& options);

  explicit Client(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}

  // Every model version being served, by name, newest version first.
  absl::StatusOr<std::vector<ModelInfo>> ListModels() const;
  // One model version and the limits that a request to it must keep.
  absl::StatusOr<ModelDetails> GetModel(const ModelChoice& choice = {}) const;
  // Waits for the whole follower.
  absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request) const;
  // The same, and hands out frames as soon as they arrive.
  absl::StatusOr<SynthesisResult> SynthesizeStreaming(const SynthesisRequest& request,
                                                      const ChunkCallback& on_chunk) const;
  // For callers that keep many calls under way and decide themselves what to do about one that
  // failed: one attempt, whatever the retry options say. Does not wait; `done` comes once, on the
  // connection's own thread, which reads all its replies and so should not be kept. The last copy
  // of a Client waits for calls under way: no `done` may hold it.
  void SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) const;

 private:
  std::shared_ptr<Connection> connection_;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_CLIENT_H_
