#ifndef DUET_CLIENT_CONNECTION_H_
#define DUET_CLIENT_CONNECTION_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/request.h"
#include "client/result.h"

namespace duet::client {

// What a Client does its work with; the seam for tests of programs that use a Client
// (client/mocks/mock_connection.h).
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
};

}  // namespace duet::client

#endif  // DUET_CLIENT_CONNECTION_H_
