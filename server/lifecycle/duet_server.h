#ifndef DUET_SERVER_LIFECYCLE_DUET_SERVER_H_
#define DUET_SERVER_LIFECYCLE_DUET_SERVER_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "server/admin/admin_service.h"
#include "server/batching/window_scheduler.h"
#include "server/common/background_thread.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/lifecycle/grpc_server.h"
#include "server/lifecycle/load_models.h"
#include "server/lifecycle/process_end.h"
#include "server/metrics/json_log.h"
#include "server/metrics/metrics_endpoint.h"
#include "server/metrics/server_metrics.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_repository.h"
#include "server/security/secret_files.h"
#include "server/service/admission.h"
#include "server/service/motion_synthesis_service.h"

namespace duet::server::lifecycle {

// Returns the files of secrets that the settings name.
inline security::SecretFiles::Options SecretsOf(const v1::ServerConfig& settings) {
  security::SecretFiles::Options secrets;
  secrets.tls = {settings.tls_certificate_file(), settings.tls_key_file(),
                 settings.tls_client_ca_file()};
  secrets.access = settings.access_file();
  return secrets;
}

// Returns the settings of the log.
metrics::LogOptions LogOptionsOf(const v1::ServerConfig& settings);

// The whole server in one object. It listens from the start, rejects calls with UNAVAILABLE until
// Serve(), and answers them until Drain().
//
//   auto server = DuetServer::Start(settings, sink);
//   (*server)->Load(source, stop);
//   (*server)->Serve();
//   ... control().Reload(done) at a signal to reload; until a signal to stop ...
//   (*server)->Drain(wait);
//
// Threads: one thread at a time, except control().
class DuetServer {
 public:
  // `settings` are resolved (config::Settings). `sink` outlives the server. `self_check` replaces
  // connecting to the server's own port. Fails with UNAVAILABLE, the setting and the reason if it
  // cannot listen on an address, and like SecretFiles::Open if its files are invalid
  // (ValidateSettings reports those before).
  static absl::StatusOr<std::unique_ptr<DuetServer>> Start(
      const v1::ServerConfig& settings, metrics::LogSink& sink,
      std::function<absl::Status()> self_check = nullptr);
  ~DuetServer();

  // Loads the models that the settings name. Logs and counts each, served or rejected. Fails if
  // there is nothing to load from, and with CANCELLED after `stop` returns true.
  absl::Status Load(const registry::ModelSource& source, const std::function<bool()>& stop);
  // Serves a loaded model, or logs why it does not load. Counts both.
  void Add(const registry::LoadReport& report) { manager_.Add(report); }

  // Opens the service: version labels, default model, health. Fails with FAILED_PRECONDITION if
  // there is no model, NOT_FOUND if the default model is not served, and INVALID_ARGUMENT if a
  // label names a model that does not exist.
  absl::Status Serve();

  // Changes models while the server runs.
  registry::ModelControl& control() { return control_; }
  int admin_port() const { return admin_grpc_.port; }
  // Uses the labels of these settings from the next reload.
  void Configure(const v1::ServerConfig& settings);

  // Reports NOT_SERVING, continues to serve for drain_seconds, lets calls finish for grace_seconds,
  // ends the rest as UNAVAILABLE, and closes. `wait` sleeps for the given seconds; if it returns
  // false, as after a second signal, both periods end.
  void Drain(const std::function<bool(double seconds)>& wait);

  int port() const { return grpc_.port; }
  int metrics_port() const { return endpoint_ == nullptr ? 0 : endpoint_->port(); }
  metrics::JsonLog& log() { return log_; }

 private:
  DuetServer(const v1::ServerConfig& settings, metrics::LogSink& sink,
             std::unique_ptr<security::SecretFiles> secrets);
  absl::Status Listen(std::function<absl::Status()> self_check);
  absl::Status ListenForAdmin();
  // Checks that the server accepts connections, answers calls, and evaluates windows that wait.
  absl::Status CheckItself();
  // Starts the periodic tasks: time limits, memory, secrets, counts of unlogged calls, the
  // self-check.
  void Watch(std::function<absl::Status()> self_check);
  void Tell(const std::vector<security::Reload>& reloads);
  // Reads certificates and the access file again and applies changes at once; Watch does so for
  // files that have stopped changing. Fails while the files on disk are invalid, even if unchanged.
  absl::Status ReloadSecrets();
  // Null: plain text.
  std::shared_ptr<grpc::ServerCredentials> Credentials() const;
  // Takes no lock: a lock that is held forever must not hide that the server is not ready.
  bool Ready() const;
  // Sets the status of the server and of each model in gRPC's health service.
  void SetHealth(bool serving);
  // Takes the result of a self-check.
  void Checked(const absl::Status& status);
  void UpdateHealth();
  void Close();
  metrics::ReadValues ReadValues(const metrics::LogSink& sink) const;
  service::ServiceParts Parts();
  admin::AdminParts AdminParts();

  const v1::ServerConfig settings_;
  metrics::JsonLog log_;
  metrics::ServerMetrics metrics_;
  const std::unique_ptr<security::SecretFiles> secrets_;
  ModelEvents events_;
  registry::ModelRegistry registry_;
  registry::ModelManager manager_;
  service::Admission admission_;
  service::TransportQuota transport_;
  const std::unique_ptr<batching::WindowScheduler> scheduler_;
  std::string engine_;  // of the models; changes before calls are admitted
  service::MotionSynthesisService service_;
  GrpcServer grpc_;
  std::atomic<bool> serving_{false};   // from Serve to Drain
  std::atomic<int> failed_checks_{0};  // self-checks in a row
  common::Mutex health_mutex_;
  std::set<std::string> health_models_ DUET_GUARDED_BY(health_mutex_);  // ever told of
  HeapTrimmer heap_trimmer_;
  std::vector<std::unique_ptr<common::RepeatedTask>> watch_;
  std::unique_ptr<LastResort> stuck_;                 // null without watchdog_seconds
  std::unique_ptr<common::RepeatedTask> self_check_;  // null without self_check_seconds
  // Used only by the self-check: the batches that it saw last, and since when the queue moves.
  std::uint64_t seen_batches_ = 0;
  common::TimePoint queue_moved_;
  std::unique_ptr<metrics::MetricsEndpoint> endpoint_;
  registry::ModelControl control_;
  admin::AdminService admin_;
  GrpcServer admin_grpc_;  // empty unless it is configured
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_DUET_SERVER_H_
