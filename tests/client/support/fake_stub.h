#ifndef DUET_TESTS_CLIENT_SUPPORT_FAKE_STUB_H_
#define DUET_TESTS_CLIENT_SUPPORT_FAKE_STUB_H_

#include <functional>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "client/internal/retry.h"
#include "client/internal/stub.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/clip.h"

namespace duet::test {

// What one stream brings, and how it ends.
struct ScriptedStream {
  std::vector<v1::SynthesizeResponse> responses;
  absl::Status end;
};

// A stub that answers as scripted, one entry for each attempt, and remembers what it was asked. An
// attempt beyond the script fails the test.
class FakeStub : public client::internal::Stub {
 public:
  absl::StatusOr<v1::ListModelsResponse> ListModels(const client::internal::CallContext& context,
                                                    const v1::ListModelsRequest& request) override;
  absl::StatusOr<v1::GetModelResponse> GetModel(const client::internal::CallContext& context,
                                                const v1::GetModelRequest& request) override;
  std::unique_ptr<client::internal::ResponseStream> Synthesize(
      const client::internal::CallContext& context, const v1::SynthesizeRequest& request) override;

  void Start(const client::internal::CallContext& context, const v1::SynthesizeRequest& request,
             std::unique_ptr<client::internal::StreamListener> listener) override;
  // Live sessions are tested with a FakeServer.
  std::unique_ptr<client::internal::LiveStream> SynthesizeLive(
      const client::internal::CallContext& context) override;

  std::vector<absl::StatusOr<v1::ListModelsResponse>> list_models;
  std::vector<absl::StatusOr<v1::GetModelResponse>> get_model;
  std::vector<ScriptedStream> streams;

  std::vector<client::internal::CallContext> contexts;
  std::vector<v1::GetModelRequest> get_model_requests;
  std::vector<v1::SynthesizeRequest> synthesize_requests;
  int cancelled = 0;

 private:
  size_t list_models_calls_ = 0;
};

// A clock that moves only when somebody sleeps or a test says so, and remembers every sleep.
struct FakeTime {
  absl::Time now = absl::UnixEpoch() + absl::Hours(1);
  std::vector<absl::Duration> sleeps;
  double uniform = 0;  // what the jitter draws

  client::internal::RetryEnvironment Environment();
};

// A leader of three joints: "root", "left", "right". Every position is different.
motion::Clip ThreeJointLeader(int frames);

// The messages of a good reply to `leader`: the follower is the leader moved by one metre in x.
v1::SynthesizeResponse HeaderFor(const motion::Clip& leader);
v1::SynthesizeResponse ChunkFor(const motion::Clip& leader, int first_frame, int frames);
v1::SynthesizeResponse SummaryFor(const motion::Clip& leader, int chunks);
// Header, chunks of `chunk_frames`, summary.
std::vector<v1::SynthesizeResponse> ReplyFor(const motion::Clip& leader, int chunk_frames);

// The follower that these replies carry.
motion::Poses FollowerFor(const motion::Clip& leader);

// A status as the server sends it, with an ErrorInfo; with a RetryInfo where `delay` is given.
absl::Status ServiceError(absl::StatusCode code, const std::string& message,
                          absl::Duration delay = absl::InfiniteDuration());

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_SUPPORT_FAKE_STUB_H_
