#include "contrib/load/grpc_target.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "contrib/load/channels.h"
#include "duet/v1/synthesis.pb.h"
#include "grpcpp/client_context.h"
#include "grpcpp/generic/generic_stub.h"
#include "grpcpp/impl/codegen/proto_utils.h"
#include "grpcpp/support/byte_buffer.h"
#include "grpcpp/support/client_callback.h"
#include "grpcpp/support/slice.h"

namespace duet::contrib::load {
namespace {

constexpr char kMethod[] = "/duet.v1.MotionSynthesis/Synthesize";

// Sends requests as bytes that were serialised once.
using Stub = grpc::TemplatedGenericStub<grpc::ByteBuffer, v1::SynthesizeResponse>;

class Call;

// Calls in flight, and ended calls that Wait has not returned yet.
class CallBook {
 public:
  void Begin(int64_t id, std::shared_ptr<Call> call) {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_.emplace(id, std::move(call));
    ++unreported_;
  }
  // Releases the call, then reports its end. A released call holds no connection: gRPC's thread
  // must not release the last reference to one, because closing it waits for that thread.
  void End(EndedCall ended) {
    Take(ended.id).reset();
    const std::lock_guard<std::mutex> lock(mutex_);
    --unreported_;
    ended_.push_back(ended);
    changed_.notify_all();
  }
  std::vector<EndedCall> Wait(Time until) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_until(lock, until, [this] { return !ended_.empty(); });
    return std::exchange(ended_, {});
  }
  void WaitUntilAllHaveEnded() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return unreported_ == 0; });
  }
  std::vector<std::shared_ptr<Call>> Open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<std::shared_ptr<Call>> calls;
    calls.reserve(open_.size());
    for (const auto& [id, call] : open_) calls.push_back(call);
    return calls;
  }

 private:
  std::shared_ptr<Call> Take(int64_t id) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = open_.find(id);
    std::shared_ptr<Call> call = std::move(found->second);
    open_.erase(found);
    return call;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::unordered_map<int64_t, std::shared_ptr<Call>> open_;
  int unreported_ = 0;  // the open calls, and those that End is releasing
  std::vector<EndedCall> ended_;
};

// One call. gRPC's threads report each message; it records times and counts frames.
class Call final : public grpc::ClientBidiReactor<grpc::ByteBuffer, v1::SynthesizeResponse> {
 public:
  Call(int64_t id, CallBook* book) : book_(book) { ended_.id = id; }

  // `request` outlives the call.
  void Begin(Stub& stub, const grpc::ByteBuffer* request, const std::string& authorization,
             absl::Duration deadline) {
    context_.set_deadline(std::chrono::system_clock::now() + absl::ToChronoMicroseconds(deadline));
    if (!authorization.empty()) context_.AddMetadata("authorization", authorization);
    stub.PrepareBidiStreamingCall(&context_, kMethod, {}, this);
    StartWriteLast(request, {});
    StartRead(&response_);
    StartCall();
  }
  void Cancel() { context_.TryCancel(); }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (response_.has_header()) wanted_ = static_cast<int>(response_.header().frame_count());
    if (response_.has_chunk()) {
      if (ended_.frames == 0) ended_.first_chunk = std::chrono::steady_clock::now();
      ended_.frames += static_cast<int>(response_.chunk().frame_count());
    }
    if (response_.has_summary()) summed_up_ = true;
    StartRead(&response_);
  }

  void OnDone(const grpc::Status& status) override {
    ended_.end = std::chrono::steady_clock::now();
    ended_.code = static_cast<absl::StatusCode>(status.error_code());
    const bool complete = summed_up_ && ended_.frames == wanted_;
    if (status.ok() && !complete) ended_.code = absl::StatusCode::kInternal;
    book_->End(ended_);  // deletes this
  }

 private:
  CallBook* const book_;
  grpc::ClientContext context_;
  v1::SynthesizeResponse response_;
  EndedCall ended_;
  int wanted_ = 0;
  bool summed_up_ = false;
};

class GrpcTarget final : public Target {
 public:
  GrpcTarget(const std::vector<std::shared_ptr<grpc::Channel>>& channels,
             const std::vector<std::string>& requests, const client::ClientOptions& options)
      : authorization_(options.token.empty() ? "" : absl::StrCat("Bearer ", options.token)),
        deadline_(options.deadline) {
    for (const auto& channel : channels) stubs_.emplace_back(channel);
    for (const std::string& request : requests) {
      const grpc::Slice slice(request);
      requests_.emplace_back(&slice, 1);
    }
  }
  GrpcTarget(const GrpcTarget&) = delete;
  GrpcTarget& operator=(const GrpcTarget&) = delete;
  ~GrpcTarget() override {
    CancelAll();
    book_.WaitUntilAllHaveEnded();
  }

  Time Now() const override { return std::chrono::steady_clock::now(); }

  void Start(int64_t id, std::size_t kind) override {
    auto call = std::make_shared<Call>(id, &book_);
    book_.Begin(id, call);
    next_stub_ = (next_stub_ + 1) % stubs_.size();
    call->Begin(stubs_[next_stub_], &requests_[kind], authorization_, deadline_);
  }

  std::vector<EndedCall> Wait(Time until) override { return book_.Wait(until); }

  // Cancelling may end a call on this thread: hold no lock.
  void CancelAll() override {
    for (const std::shared_ptr<Call>& call : book_.Open()) call->Cancel();
  }

 private:
  const std::string authorization_;
  const absl::Duration deadline_;
  std::vector<Stub> stubs_;
  std::vector<grpc::ByteBuffer> requests_;
  std::size_t next_stub_ = 0;
  CallBook book_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Target>> ConnectTarget(const client::ClientOptions& options,
                                                      int connections,
                                                      const std::vector<std::string>& requests) {
  const auto channels = OpenChannels(options, connections);
  if (!channels.ok()) return channels.status();
  return std::make_unique<GrpcTarget>(*channels, requests, options);
}

}  // namespace duet::contrib::load
