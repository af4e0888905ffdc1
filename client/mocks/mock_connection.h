#ifndef DUET_CLIENT_MOCKS_MOCK_CONNECTION_H_
#define DUET_CLIENT_MOCKS_MOCK_CONNECTION_H_

#include <memory>
#include <vector>

#include "client/connection.h"
#include "client/live_session.h"
#include "gmock/gmock.h"

namespace duet::client {

// For tests of programs that use a Client: Client(std::make_shared<MockConnection>()).
class MockConnection : public Connection {
 public:
  MOCK_METHOD(absl::StatusOr<std::vector<ModelInfo>>, ListModels, (), (override));
  MOCK_METHOD(absl::StatusOr<ModelDetails>, GetModel, (const ModelChoice& choice), (override));
  MOCK_METHOD(absl::StatusOr<SynthesisResult>, Synthesize,
              (const SynthesisRequest& request, const ChunkCallback& on_chunk), (override));
  MOCK_METHOD(absl::StatusOr<std::unique_ptr<LiveSession>>, StartLive,
              (const LiveRequest& request, LiveCallbacks callbacks), (override));
};

// The session that a MockConnection's StartLive returns.
class MockLiveSession : public LiveSession {
 public:
  MOCK_METHOD(const LiveInfo&, info, (), (const, override));
  MOCK_METHOD(absl::Status, Send,
              (int first_frame, absl::Span<const motion::Vec3> positions, double capture_seconds),
              (override));
  MOCK_METHOD(absl::Status, ChangeLabels,
              (const std::vector<ClassWeight>& weights, absl::Duration ease), (override));
  MOCK_METHOD(absl::StatusOr<LiveSummary>, Finish, (), (override));
};

}  // namespace duet::client

#endif  // DUET_CLIENT_MOCKS_MOCK_CONNECTION_H_
