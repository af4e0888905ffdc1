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

void WriteLimits(const ServerOptions& options, v1::ServerConfig* config) {
  config->set_workers(static_cast<uint32_t>(options.workers));
  config->set_max_calls(static_cast<uint32_t>(options.max_calls));
  config->set_max_queued_windows(static_cast<uint32_t>(options.max_queued_windows));
  config->set_max_batch_windows(static_cast<uint32_t>(options.max_batch_windows));
  config->set_max_batch_delay_seconds(options.max_batch_delay_seconds);
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
  config.set_model_repository(options.model_repository.string());
  config.set_default_model(options.default_model);
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
  config.set_clean_up(CleanUpMessage(options.clean_up));
  return config;
}

}  // namespace duet::server::config
