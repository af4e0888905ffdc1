#include "contrib/load/server_sessions.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/internal/proto_conversion.h"
#include "contrib/load/inbox.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "grpcpp/client_context.h"
#include "grpcpp/support/client_callback.h"

namespace duet::contrib::load {
namespace {

using Stub = v1::MotionSynthesis::Stub;

// One session. gRPC's threads report each message. Messages are written one at a time; those that
// wait are in a queue. gRPC may call back on the thread that starts an operation, so no lock is
// held meanwhile.
class Session final
    : public grpc::ClientBidiReactor<v1::SynthesizeLiveRequest, v1::SynthesizeLiveResponse>,
      public std::enable_shared_from_this<Session> {
 public:
  Session(int index, Inbox<LiveEvent>* events) : index_(index), events_(events) {}

  void Begin(Stub& stub, const std::string& authorization, absl::Duration longest,
             v1::SynthesizeLiveRequest start) {
    self_ = shared_from_this();
    context_.set_deadline(std::chrono::system_clock::now() + absl::ToChronoMicroseconds(longest));
    if (!authorization.empty()) context_.AddMetadata("authorization", authorization);
    stub.async()->SynthesizeLive(&context_, this);
    AddHold();  // until the stream has ended: Write comes from outside its callbacks
    StartRead(&response_);
    StartCall();
    Write(std::move(start));
  }

  void Write(v1::SynthesizeLiveRequest message) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (stream_ended_ || finishing_) return;
      waiting_.push_back(std::move(message));
    }
    WriteNext();
  }
  void Finish() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      finishing_ = true;
    }
    WriteNext();
  }
  void Cancel() { context_.TryCancel(); }

  void OnReadDone(bool ok) override {
    if (!ok) return EndStream();
    LiveEvent event;
    event.session = index_;
    event.time = std::chrono::steady_clock::now();
    if (response_.has_frames()) {
      event.first_frame = static_cast<int>(response_.frames().first_frame());
      event.frames = static_cast<int>(response_.frames().frame_count());
      event.server_seconds = double{response_.frames().server_seconds()};
      if (event.frames > 0) events_->Add(event, false);
    } else if (response_.has_summary()) {
      summed_up_ = true;
      ended_.skipped_frames = static_cast<int>(response_.summary().skipped_frames());
    }
    StartRead(&response_);
  }
  void OnWriteDone(bool /*ok*/) override { EndWrite(); }
  void OnWritesDoneDone(bool /*ok*/) override { EndWrite(); }

  void OnDone(const grpc::Status& status) override {
    ended_.code = static_cast<absl::StatusCode>(status.error_code());
    if (status.ok() && !summed_up_) ended_.code = absl::StatusCode::kInternal;
    LiveEvent event;
    event.session = index_;
    event.time = std::chrono::steady_clock::now();
    event.ended = ended_;
    // Release the session first. It holds a connection, and gRPC's thread must not release the last
    // reference to one, because closing it waits for that thread.
    Inbox<LiveEvent>* const events = events_;
    std::exchange(self_, nullptr).reset();
    events->Add(event, true);
  }

 private:
  // Starts the next write, or the end of writing, unless one is running.
  void WriteNext() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (stream_ended_ || writing_ || wrote_all_) return;
      if (waiting_.empty() && !finishing_) return;
      writing_ = true;
      wrote_all_ = waiting_.empty();
      if (!wrote_all_) {
        written_ = std::move(waiting_.front());
        waiting_.pop_front();
      }
    }
    // wrote_all_ and written_ change only while nothing is being written.
    if (wrote_all_) {
      StartWritesDone();
    } else {
      StartWrite(&written_);
    }
  }
  void EndWrite() {
    bool last = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      writing_ = false;
      last = stream_ended_;
    }
    last ? RemoveHold() : WriteNext();
  }
  void EndStream() {
    bool last = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stream_ended_ = true;
      last = !writing_;
    }
    if (last) RemoveHold();
  }

  const int index_;
  Inbox<LiveEvent>* const events_;
  grpc::ClientContext context_;
  v1::SynthesizeLiveResponse response_;
  EndedSession ended_;
  bool summed_up_ = false;
  std::shared_ptr<Session> self_;  // until it is done

  std::mutex mutex_;
  std::deque<v1::SynthesizeLiveRequest> waiting_;
  v1::SynthesizeLiveRequest written_;
  bool writing_ = false, finishing_ = false, wrote_all_ = false, stream_ended_ = false;
};

class ServerSessions final : public LiveTarget {
 public:
  ServerSessions(const std::vector<std::shared_ptr<grpc::Channel>>& channels,
                 const client::ClientOptions& options, v1::LiveStart start, absl::Duration longest)
      : authorization_(options.token.empty() ? "" : absl::StrCat("Bearer ", options.token)),
        longest_(longest),
        start_(std::move(start)),
        begin_(Now()) {
    for (const auto& channel : channels) stubs_.push_back(v1::MotionSynthesis::NewStub(channel));
  }
  ServerSessions(const ServerSessions&) = delete;
  ServerSessions& operator=(const ServerSessions&) = delete;
  ~ServerSessions() override {
    CancelAll();
    events_.WaitUntilNoneIsOpen();
  }

  Time Now() const override { return std::chrono::steady_clock::now(); }

  void Open(int session) override {
    const std::size_t index = static_cast<std::size_t>(session);
    if (sessions_.size() <= index) sessions_.resize(index + 1);
    sessions_[index] = std::make_shared<Session>(session, &events_);
    events_.Opened();
    v1::SynthesizeLiveRequest request;
    *request.mutable_start() = start_;
    request.mutable_start()->set_seed(index);
    sessions_[index]->Begin(*stubs_[index % stubs_.size()], authorization_, longest_,
                            std::move(request));
  }

  void Send(int session, int frame) override {
    const std::size_t index = static_cast<std::size_t>(session);
    v1::SynthesizeLiveRequest request;
    v1::LeaderFrames* frames = request.mutable_frames();
    frames->set_first_frame(static_cast<uint32_t>(frame));
    frames->set_frame_count(1);
    frames->set_capture_seconds(ToSeconds(Now() - begin_));
    for (int j = 0; j < start_.leader().joint_names_size(); ++j) {
      const motion::Vec3 joint = SwayingJoint(frame, j);
      for (const float value : {joint.x, joint.y, joint.z}) frames->add_positions(value);
    }
    sessions_[index]->Write(std::move(request));
  }

  void Finish(int session) override { sessions_[static_cast<std::size_t>(session)]->Finish(); }
  std::vector<LiveEvent> Wait(Time until) override { return events_.Wait(until); }
  void CancelAll() override {
    for (const std::shared_ptr<Session>& session : sessions_) {
      if (session != nullptr) session->Cancel();
    }
  }

 private:
  const std::string authorization_;
  const absl::Duration longest_;
  const v1::LiveStart start_;
  const Time begin_;
  Inbox<LiveEvent> events_;
  std::vector<std::unique_ptr<Stub>> stubs_;
  std::vector<std::shared_ptr<Session>> sessions_;
};

// The first message of a session with leader frames at a rate, without frames.
// Errors: INVALID_ARGUMENT for values that the proto cannot represent.
absl::StatusOr<v1::LiveStart> MakeLiveStart(const CallContent& content,
                                            const client::ModelInfo& model, double frame_rate_hz) {
  client::SynthesisRequest request;
  request.model = content.model;
  request.leader.joint_names = model.joint_names;
  request.leader.frame_rate_hz = frame_rate_hz;
  request.weights = content.labels;
  if (request.weights.empty()) request.weights = {{model.interaction_classes.front(), 1}};
  absl::StatusOr<v1::SynthesizeRequest> wire = client::internal::ToProto(request);
  if (!wire.ok()) return wire.status();
  v1::LiveStart start;
  *start.mutable_model() = wire->model();
  *start.mutable_leader() = wire->leader();
  *start.mutable_label_vector() = wire->label_vector();
  return start;
}

}  // namespace

absl::StatusOr<std::unique_ptr<LiveTarget>> ConnectSessions(const client::ClientOptions& options,
                                                            int connections,
                                                            const LiveSessions& sessions) {
  const absl::StatusOr<v1::LiveStart> start =
      MakeLiveStart(sessions.content, sessions.model, sessions.frame_rate_hz);
  if (!start.ok()) return start.status();
  const auto channels = OpenChannels(options, connections);
  if (!channels.ok()) return channels.status();
  return std::make_unique<ServerSessions>(*channels, options, *start, sessions.longest);
}

}  // namespace duet::contrib::load
