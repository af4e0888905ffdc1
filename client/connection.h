#ifndef DUET_CLIENT_CONNECTION_H_
#define DUET_CLIENT_CONNECTION_H_

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/live_session.h"
#include "client/request.h"
#include "client/result.h"

namespace duet::client {

// Called once, with the result of a call.
using SynthesisCallback = std::function<void(absl::StatusOr<SynthesisResult>)>;

// The connection of a Client to a server. Tests of programs that use a Client replace it with
// client/mocks/mock_connection.h.
//
// Threads: implementations are safe to call concurrently.
class Connection {
 public:
  virtual ~Connection() = default;

  virtual absl::StatusOr<std::vector<ModelInfo>> ListModels() = 0;
  virtual absl::StatusOr<ModelDetails> GetModel(const ModelChoice& choice) = 0;
  // `on_chunk` may be empty.
  virtual absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request,
                                                     const ChunkCallback& on_chunk) = 0;
  // Makes one attempt. The default implementation blocks and calls `done` before it returns.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): other implementations keep the request.
  virtual void SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) {
    done(Synthesize(request, nullptr));
  }
  // The default implementation returns UNIMPLEMENTED, for connections without live sessions.
  virtual absl::StatusOr<std::unique_ptr<LiveSession>> StartLive(
      const LiveRequest& /*request*/,
      // NOLINTNEXTLINE(performance-unnecessary-value-param): other implementations keep it.
      LiveCallbacks /*callbacks*/) {
    return absl::UnimplementedError("this connection has no live sessions");
  }
};

}  // namespace duet::client

#endif  // DUET_CLIENT_CONNECTION_H_
