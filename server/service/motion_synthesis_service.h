#ifndef DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_
#define DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "duet/v1/synthesis.pb.h"
#include "server/batching/window_scheduler.h"
#include "server/common/background_thread.h"
#include "server/common/clock.h"
#include "server/metrics/call_record.h"
#include "server/registry/model_registry.h"
#include "server/security/access_control.h"
#include "server/service/admission.h"
#include "server/service/call.h"
#include "server/service/clip_replies.h"
#include "server/service/validator.h"

namespace duet::server::service {

// Dependencies and settings of the service. All pointers outlive the service and its calls.
struct ServiceParts {
  registry::ModelRegistry* registry = nullptr;
  batching::WindowScheduler* scheduler = nullptr;
  Admission* admission = nullptr;
  TransportQuota* transport = nullptr;  // null: not notified of received requests
  std::vector<metrics::CallObserver*> observers;
  const common::Clock* clock = &common::Clock::Real();
  RequestLimits limits;
  ReceptionLimits reception;
  int buffered_frames = 0;  // see ReplyParts
  // Maximum time that one reply may wait for its reader, and maximum duration of a call. CheckTime
  // enforces both.
  double write_timeout_seconds = std::numeric_limits<double>::infinity();
  double max_call_seconds = std::numeric_limits<double>::infinity();
  double live_idle_seconds = 60;                    // see ReplyParts
  std::string client_key;                           // see CallPipeline
  const security::AccessControl* access = nullptr;  // see CallPipeline
  // Whether followers are cleaned up if the request does not specify it. Absent: the model's
  // default (ModelDescription::cleaned_up_by_default).
  std::optional<bool> clean_up;
  // What replies state about the server. The engine is set before calls are admitted; null: none.
  const std::string* engine = nullptr;
  std::string version;
};

// Implements duet.v1.MotionSynthesis. No method blocks or occupies a gRPC thread for long.
//
// Every call passes the CallPipeline and is admitted before its message is read. It continues with
// model -> validator -> ReplySource, and lives until its last reply was taken or the caller went
// away.
class MotionSynthesisService final : public RawService {
 public:
  static constexpr char kServiceName[] = "duet.v1.MotionSynthesis";

  explicit MotionSynthesisService(ServiceParts parts);

  // Notifies callers of live sessions, which have no end of their own, that the server drains. Call
  // when no more calls are admitted.
  void AnnounceDrain() { calls_.Drain(); }

  // Ends every call in progress.
  void AbortAll(const absl::Status& reason) { calls_.AbortAll(reason); }

  // Waits until every call has its status, at most `seconds`, then breaks off writes that are still
  // in progress. Call after AbortAll.
  void FinishAborted(double seconds) { calls_.FinishAborted(seconds); }

  // Ends the calls whose time to arrive, to be processed or to be read has passed. Call every few
  // hundredths of a second.
  void CheckTime() { calls_.CheckTime(parts_.clock->Now()); }

  // Total size of all large requests so far, in bytes. Their memory can be returned to the system.
  std::uint64_t large_request_bytes() const { return large_request_bytes_; }

 private:
  using Context = grpc::CallbackServerContext;

  // The first message of a call. The context lives until the call ends.
  struct Received {
    const Context& context;
    std::shared_ptr<Call> call;
    grpc::ByteBuffer bytes;
    ShareLease held;  // accounts for the bytes until the call ends
    std::shared_ptr<TransportQuota::Received> transport;  // likewise, until they are parsed
  };
  struct Method {
    metrics::MethodInfo info;
    // Parses the first message and finds out how to answer it.
    absl::StatusOr<Call::Stream> (MotionSynthesisService::*prepare)(Received received);
    std::size_t max_bytes;  // of the first message, if less than the server's limit
    bool takes_place;       // among the concurrent calls
    // The call is refused while the queue has no room for its first window.
    bool needs_room;
  };
  static const Method kListModels, kGetModel, kSynthesize, kSynthesizeLive;

  // Opens and admits a call.
  Reactor* Open(Context* context, const Method& method);
  // Handles the first message of a call. Large messages are handled on a thread of their own,
  // because they would occupy one of gRPC's few threads.
  void Handle(const Method& method, Received received);
  void HandleElsewhere(const Method& method, Received received);
  void Run(const Method& method, Received received);
  // Parses the message and frees its bytes.
  static absl::Status Parse(Received& received, google::protobuf::Message& request);
  // Method::prepare of each method.
  absl::StatusOr<Call::Stream> PrepareList(Received received);
  absl::StatusOr<Call::Stream> PrepareGet(Received received);
  absl::StatusOr<Call::Stream> Prepare(Received received);
  absl::StatusOr<Call::Stream> PrepareLive(Received received);
  // Finds the model that a request selects. `prefix`: precedes the fields in errors, as "start.".
  absl::StatusOr<registry::ServedModel> FindModel(const v1::ModelSelector& selector,
                                                  absl::string_view prefix = "") const;
  // What the replies of a call depend on. `max_seconds`: the longest time for the whole call.
  ReplyParts PartsOf(const Received& received, const registry::ServedModel& served,
                     double max_seconds) const;
  // Decides whether followers are cleaned up if the request does not.
  void SetCleanUp(const engine::ModelDescription& model, engine::SynthesisOptions& options) const;

  const ServiceParts parts_;
  const CallPipeline pipeline_;
  ActiveCalls calls_;
  std::atomic<std::uint64_t> large_request_bytes_{0};
  common::BackgroundThread large_requests_{common::BackgroundThread::Share::kOrdinary};
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_MOTION_SYNTHESIS_SERVICE_H_
