#ifndef DUET_CLIENT_MOCKS_MOCK_CONNECTION_H_
#define DUET_CLIENT_MOCKS_MOCK_CONNECTION_H_

#include <vector>

#include "client/connection.h"
#include "gmock/gmock.h"

namespace duet::client {

// For tests of programs that use a Client: Client(std::make_shared<MockConnection>()).
class MockConnection : public Connection {
 public:
  MOCK_METHOD(absl::StatusOr<std::vector<ModelInfo>>, ListModels, (), (override));
  MOCK_METHOD(absl::StatusOr<ModelDetails>, GetModel, (const ModelChoice& choice), (override));
  MOCK_METHOD(absl::StatusOr<SynthesisResult>, Synthesize,
              (const SynthesisRequest& request, const ChunkCallback& on_chunk), (override));
};

}  // namespace duet::client

#endif  // DUET_CLIENT_MOCKS_MOCK_CONNECTION_H_
