#ifndef DUET_CLIENT_INTERNAL_LIVE_SESSION_IMPL_H_
#define DUET_CLIENT_INTERNAL_LIVE_SESSION_IMPL_H_

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/internal/live_state.h"
#include "client/internal/retry.h"
#include "client/live_session.h"
#include "client/options.h"
#include "duet/v1/synthesis.grpc.pb.h"

namespace duet::client::internal {

// What a session takes from its connection.
struct LiveSettings {
  ClientOptions client;
  RetryEnvironment environment;
  // A stream that owes frames and is silent for this long counts as broken.
  absl::Duration longest_silence = absl::Seconds(5);
  // A stream that lasts this long, or answers a frame, shows that the server works: another break
  // is a new one, with its own time limits.
  absl::Duration proof = absl::Seconds(5);
};

// A session over the streams of a service. Two threads: the reader opens streams, reads them and
// calls the callbacks; the writer writes what was sent. The state is under one mutex, which neither
// of them holds while it waits for the network or runs a callback.
class LiveSessionImpl final : public LiveSession {
 public:
  // Blocks until the first stream has its header.
  static absl::StatusOr<std::unique_ptr<LiveSession>> Start(
      std::shared_ptr<v1::MotionSynthesis::Stub> stub, const LiveRequest& request,
      LiveCallbacks callbacks, LiveSettings settings);
  LiveSessionImpl(const LiveSessionImpl&) = delete;
  LiveSessionImpl& operator=(const LiveSessionImpl&) = delete;
  ~LiveSessionImpl() override;

  const LiveInfo& info() const override { return info_; }
  absl::Status Send(int first_frame, absl::Span<const motion::Vec3> positions,
                    double capture_seconds) override;
  absl::Status ChangeLabels(const std::vector<ClassWeight>& weights, absl::Duration ease) override;
  absl::StatusOr<LiveSummary> Finish() override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  using SteadyTime = std::chrono::steady_clock::time_point;
  using Stream = grpc::ClientReaderWriter<v1::SynthesizeLiveRequest, v1::SynthesizeLiveResponse>;

  LiveSessionImpl(std::shared_ptr<v1::MotionSynthesis::Stub> stub, LiveState state,
                  std::string request_id, LiveCallbacks callbacks, LiveSettings settings);

  absl::Status CheckOpen() const;  // requires the lock
  void Enqueue(v1::SynthesizeLiveRequest message);

  // The reader's thread.
  void Read();
  absl::Status RunUntilBroken();
  AttemptEnd RunStream();
  bool OpenStream();
  bool Handle(const v1::SynthesizeLiveResponse& response);
  absl::Status CloseStream();
  bool HasProof(SteadyTime opened, int delivered_before) const;
  RetryEnvironment InterruptibleEnvironment();
  void Notify(LiveNotice::Kind kind, const std::string& message = "");

  // The writer's thread.
  void Write();
  bool HasWork() const;
  void WriteOne(Lock* lock);
  std::chrono::nanoseconds SilenceCheckPeriod() const;
  // Cancels a stream that owes something and is silent. Requires the lock.
  void CheckSilence();

  const std::shared_ptr<v1::MotionSynthesis::Stub> stub_;
  const std::string request_id_;
  const LiveCallbacks callbacks_;
  const LiveSettings settings_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  LiveState state_;
  std::deque<v1::SynthesizeLiveRequest> outgoing_;
  std::unique_ptr<grpc::ClientContext> context_;  // of stream_
  std::unique_ptr<Stream> stream_;
  bool can_write_ = false;  // the stream takes messages
  bool writing_ = false;    // the writer is using the stream
  bool half_closed_ = false;
  bool finishing_ = false;  // Finish was called
  bool abandoned_ = false;  // the destructor was called
  bool silent_ = false;     // the stream was cancelled because it was silent
  SteadyTime heard_;        // when the server last wrote, or first owed something
  std::optional<absl::Status> ended_;
  // Of the reader's thread.
  absl::Status rejected_;  // the contract or the callback ended the session
  bool draining_ = false;  // the server of this stream shuts down
  bool broken_ = false;    // a stream had begun and broke

  LiveInfo info_;
  std::thread reader_, writer_;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_LIVE_SESSION_IMPL_H_
