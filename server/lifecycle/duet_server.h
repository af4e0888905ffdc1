#ifndef DUET_SERVER_LIFECYCLE_DUET_SERVER_H_
#define DUET_SERVER_LIFECYCLE_DUET_SERVER_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/batching/window_scheduler.h"
#include "server/config/server_options.h"
#include "server/lifecycle/grpc_server.h"
#include "server/lifecycle/heap_trimmer.h"
#include "server/lifecycle/repeated_task.h"
#include "server/lifecycle/self_check.h"
#include "server/metrics/json_log.h"
#include "server/metrics/metrics_endpoint.h"
#include "server/metrics/server_metrics.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_repository.h"
#include "server/security/secret_files.h"
#include "server/service/admission.h"
#include "server/service/motion_synthesis_service.h"
#include "server/tracing/call_tracer.h"

namespace duet::server::lifecycle {

// The part of the options that the log keeps to.
metrics::LogOptions LogOptionsOf(const config::LoggingOptions& options);

// The whole server in one object: listens from the start, refuses calls as UNAVAILABLE until
// Serve(), answers them until Drain().
//
//   auto server = DuetServer::Start(options, sink);
//   (*server)->Add(LoadCheckpoint(folder, loader));
//   (*server)->Serve();
//   ... until asked to stop ...
//   (*server)->Drain(wait);
//
// Threads: one thread at a time.
class DuetServer {
 public:
  // `sink` outlives the server. Fails with UNAVAILABLE when an address cannot be listened on; as
  // SecretFiles::Open and CallTracer::Open when what they are given makes no sense.
  static absl::StatusOr<std::unique_ptr<DuetServer>> Start(const config::ServerOptions& options,
                                                           metrics::LogSink& sink);
  ~DuetServer();

  // Serves a loaded model, or logs why it is not; both are counted.
  void Add(const registry::LoadReport& report);

  // The model that answers when a request names none, unless the options name one. NOT_FOUND when
  // it is not served.
  absl::Status SetDefault(const std::string& model) { return registry_.SetDefault(model); }

  // Opens the service: version labels, default model, health. Fails with FAILED_PRECONDITION when
  // there is no model, NOT_FOUND when the default model is not among them.
  absl::Status Serve();

  // Says NOT_SERVING, serves on for drain_seconds, then lets calls finish for grace_seconds, ends
  // the others as UNAVAILABLE and closes. `wait` sleeps for so many seconds; when it gives false,
  // as after a second signal, both times are cut short.
  void Drain(const std::function<bool(double seconds)>& wait);

  // Reads certificates and the access file again and takes over what changed, at once. By itself
  // that happens every second, for files that do not change any more. Safe to call concurrently.
  void RefreshSecrets() { Tell(secrets_->Refresh()); }

  int port() const { return grpc_.port; }
  int metrics_port() const { return endpoint_ == nullptr ? 0 : endpoint_->port(); }
  metrics::JsonLog& log() { return log_; }

 private:
  DuetServer(const config::ServerOptions& options, metrics::LogSink& sink,
             std::unique_ptr<security::SecretFiles> secrets,
             std::unique_ptr<tracing::CallTracer> tracer);
  absl::Status Listen();
  // Starts what looks after the server while it runs: time limits, memory, secrets, the
  // log's counts, its own port.
  void Watch();
  void Tell(const std::vector<security::Reload>& reloads);
  // Null: plain text.
  std::shared_ptr<grpc::ServerCredentials> Credentials() const;
  void SetHealth(bool serving);
  void Close();
  service::ServiceParts Parts();

  const config::ServerOptions options_;
  metrics::JsonLog log_;
  const std::unique_ptr<tracing::CallTracer> tracer_;  // null: spans go nowhere
  metrics::ServerMetrics metrics_;
  const std::unique_ptr<security::SecretFiles> secrets_;
  registry::ModelRegistry registry_;
  service::Admission admission_;
  const std::unique_ptr<batching::WindowScheduler> scheduler_;
  service::MotionSynthesisService service_;
  GrpcServer grpc_;
  HeapTrimmer heap_trimmer_;
  std::vector<std::unique_ptr<RepeatedTask>> watch_;
  std::unique_ptr<SelfCheck> self_check_;  // null when the options want none
  std::unique_ptr<metrics::MetricsEndpoint> endpoint_;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_DUET_SERVER_H_
