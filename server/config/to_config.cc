#include "duet/v1/server_config.pb.h"
#include "server/config/server_options.h"

namespace duet::server::config {
namespace {

void WriteEngine(const EngineOptions& engine, v1::ServerConfig* config) {
  using Engine = EngineOptions::Engine;
  using Precision = EngineOptions::Precision;
  config->set_engine(engine.engine == Engine::kTorch ? v1::ENGINE_TORCH : v1::ENGINE_CPU);
  switch (engine.precision) {
    case Precision::kAuto:
      config->set_precision(v1::PRECISION_AUTO);
      break;
    case Precision::kFloat32:
      config->set_precision(v1::PRECISION_F32);
      break;
    case Precision::kBfloat16:
      config->set_precision(v1::PRECISION_BF16);
      break;
  }
  config->set_threads_per_worker(static_cast<uint32_t>(engine.threads));
}

v1::CleanUpPolicy CleanUpMessage(std::optional<bool> clean_up) {
  if (!clean_up.has_value()) return v1::CLEAN_UP_POLICY_AUTO;
  return *clean_up ? v1::CLEAN_UP_POLICY_ON : v1::CLEAN_UP_POLICY_OFF;
}

// Files and addresses that are not there are left out.
void WriteSecurity(const SecurityOptions& security, v1::ServerConfig* config) {
  const auto set = [config](auto setter, const std::string& path) {
    if (!path.empty()) (config->*setter)(path);
  };
  using SetText = void (v1::ServerConfig::*)(const std::string&);
  set(static_cast<SetText>(&v1::ServerConfig::set_tls_certificate_file),
      security.tls_certificate_file.string());
  set(static_cast<SetText>(&v1::ServerConfig::set_tls_key_file), security.tls_key_file.string());
  set(static_cast<SetText>(&v1::ServerConfig::set_tls_client_ca_file),
      security.tls_client_ca_file.string());
  set(static_cast<SetText>(&v1::ServerConfig::set_access_file), security.access_file.string());
}

void WriteObservability(const ServerOptions& options, v1::ServerConfig* config) {
  using Format = LoggingOptions::Format;
  using Level = LoggingOptions::Level;
  const LoggingOptions& logging = options.logging;
  if (!options.tracing.otlp_endpoint.empty()) {
    config->set_otlp_endpoint(options.tracing.otlp_endpoint);
  }
  config->set_trace_ratio(options.tracing.ratio);
  config->set_log_format(logging.format == Format::kText ? v1::LOG_FORMAT_TEXT
                                                         : v1::LOG_FORMAT_JSON);
  config->set_log_level(logging.level == Level::kError     ? v1::LOG_LEVEL_ERROR
                        : logging.level == Level::kWarning ? v1::LOG_LEVEL_WARNING
                                                           : v1::LOG_LEVEL_INFO);
  config->set_log_success_ratio(logging.success_ratio);
  config->set_log_refusals_per_second(static_cast<uint32_t>(logging.refusals_per_second));
}

void WriteSharing(const ServerOptions& options, v1::ServerConfig* config) {
  config->set_client_share(options.client_share);
  if (!options.client_key.empty()) config->set_client_key(options.client_key);
  config->set_max_held_bytes(options.max_held_bytes);
  config->set_receive_timeout_seconds(options.receive_timeout_seconds);
  config->set_max_slow_requests(static_cast<uint32_t>(options.max_slow_requests));
  config->set_write_timeout_seconds(options.write_timeout_seconds);
  config->set_max_call_seconds(options.max_call_seconds);
  config->set_self_check_seconds(options.self_check_seconds);
  config->set_watchdog_seconds(options.watchdog_seconds);
}

void WriteLimits(const ServerOptions& options, v1::ServerConfig* config) {
  config->set_workers(static_cast<uint32_t>(options.workers));
  config->set_max_calls(static_cast<uint32_t>(options.max_calls));
  config->set_max_queued_windows(static_cast<uint32_t>(options.max_queued_windows));
  config->set_max_batch_windows(static_cast<uint32_t>(options.max_batch_windows));
  config->set_max_batch_delay_seconds(options.max_batch_delay_seconds);
  config->set_memory_limit_bytes(options.memory_limit_bytes);
  config->set_max_request_bytes(options.max_request_bytes);
  config->set_max_transport_bytes(options.max_transport_bytes);
  config->set_buffered_frames(static_cast<uint32_t>(options.buffered_frames));
  config->set_drain_seconds(options.drain_seconds);
  config->set_grace_seconds(options.grace_seconds);
}

}  // namespace

v1::ServerConfig ToConfig(const ServerOptions& options) {
  v1::ServerConfig config;
  config.set_listen(ToString(options.listen));
  config.set_metrics_listen(options.metrics_listen.has_value() ? ToString(*options.metrics_listen)
                                                               : "off");
  if (!options.model_repository.empty()) {
    config.set_model_repository(options.model_repository.string());
  }
  if (!options.default_model.empty()) config.set_default_model(options.default_model);
  for (const VersionLabelOption& label : options.version_labels) {
    v1::VersionLabel* message = config.add_version_labels();
    message->set_model(label.model);
    message->set_label(label.label);
    message->set_version(label.version);
  }
  for (const VersionPolicyOption& policy : options.version_policies) {
    v1::VersionPolicy* message = config.add_version_policies();
    message->set_model(policy.model.empty() ? "*" : policy.model);
    if (policy.latest.has_value()) message->set_latest(*policy.latest);
    for (const uint32_t version : policy.versions) message->add_versions(version);
  }
  config.set_admin_listen(options.admin_listen.has_value() ? ToString(*options.admin_listen)
                                                           : "off");
  config.set_reflection(options.reflection);
  WriteEngine(options.engine, &config);
  WriteLimits(options, &config);
  WriteSharing(options, &config);
  WriteSecurity(options.security, &config);
  WriteObservability(options, &config);
  config.set_clean_up(CleanUpMessage(options.clean_up));
  return config;
}

}  // namespace duet::server::config
