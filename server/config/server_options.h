#ifndef DUET_SERVER_CONFIG_SERVER_OPTIONS_H_
#define DUET_SERVER_CONFIG_SERVER_OPTIONS_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "server/config/memory_limit.h"
#include "server/config/setting_sources.h"

namespace duet::server::config {

// A host and a port to listen on.
struct ListenAddress {
  std::string host;
  int port = 0;  // 0: any free one
};

struct VersionLabelOption {
  std::string model;
  std::string label;
  uint32_t version = 0;
};

struct VersionPolicyOption {
  std::string model;  // empty: every model without a policy of its own
  std::optional<uint32_t> latest;
  std::vector<uint32_t> versions;
};

// What computes the answers, and how. server_config.proto says more.
struct EngineOptions {
  enum class Engine { kCpu, kTorch };
  enum class Precision { kAuto, kFloat32, kBfloat16 };
  Engine engine = Engine::kCpu;
  Precision precision = Precision::kAuto;  // of kCpu
  int threads = 1;                         // of one evaluation
};

// Files that are read again when they change. An empty path: none.
struct SecurityOptions {
  std::filesystem::path tls_certificate_file;
  std::filesystem::path tls_key_file;
  std::filesystem::path tls_client_ca_file;
  std::filesystem::path access_file;
};

// What is written to standard error, and how.
struct LoggingOptions {
  enum class Format { kJson, kText };
  enum class Level { kInfo, kWarning, kError };
  Format format = Format::kJson;
  Level level = Level::kInfo;
  double success_ratio = 1;      // of successful calls, that get a line
  int refusals_per_second = 10;  // of one status code, that get a line
};

// Spans of calls.
struct TracingOptions {
  std::string otlp_endpoint;  // empty: not sent anywhere
  double ratio = 1;           // of calls that come without a trace
};

// Where memory is not short, enough of it for as many of the largest requests at a time.
inline constexpr std::size_t kTransportPerRequest = 16;

// Everything that an operator decides, checked. server_config.proto says what each means; the
// defaults stand here and nowhere else.
struct ServerOptions {
  ListenAddress listen = {"0.0.0.0", 50051};
  std::optional<ListenAddress> metrics_listen = ListenAddress{"0.0.0.0", 9464};
  std::filesystem::path model_repository;  // empty: the embedded checkpoints
  std::string default_model;
  std::vector<VersionLabelOption> version_labels;
  std::vector<VersionPolicyOption> version_policies;
  std::optional<ListenAddress> admin_listen;
  bool reflection = true;
  std::optional<bool> clean_up;  // absent: followers of models that sample are cleaned up
  EngineOptions engine;
  SecurityOptions security;
  LoggingOptions logging;
  TracingOptions tracing;
  int workers = 1;  // ToOptions: as many as the cores allow
  // What the limits below that an operator leaves open follow from; see memory_plan.h.
  std::uint64_t memory_limit_bytes = kUnlimitedMemory;
  int max_calls = 128;
  int max_queued_windows = 64;
  int max_batch_windows = 16;
  double max_batch_delay_seconds = 0;
  std::size_t max_request_bytes = std::size_t{32} << 20;
  std::size_t max_transport_bytes = kTransportPerRequest * max_request_bytes;
  double client_share = 0.75;
  std::string client_key;  // empty: clients are addresses
  std::size_t max_held_bytes = kTransportPerRequest * max_request_bytes;
  double receive_timeout_seconds = 30;
  int max_slow_requests = kTransportPerRequest / 2;
  double write_timeout_seconds = 30;
  double max_call_seconds = 660;  // ten minutes of motion, watched as it comes, and a little more
  double self_check_seconds = 10;
  double watchdog_seconds = max_call_seconds;  // 0: off
  int buffered_frames = 240;
  double drain_seconds = 0;
  double grace_seconds = 30;
};

// The options of a configuration, and everything that is wrong with it.
struct Settings {
  ServerOptions options;  // of fields that are wrong, some other value
  // A line for each: "field: expected ..., got ... (where it comes from, if known); hint".
  std::vector<std::string> mistakes;
};

// Fills in defaults and checks every field, by itself and against the others, without looking at
// files or the network. `cores` and `memory_bytes` are what the container may use.
Settings ReadSettings(const v1::ServerConfig& config, int cores, const SettingSources& sources = {},
                      std::uint64_t memory_bytes = kUnlimitedMemory);

// The same, failing with INVALID_ARGUMENT and all mistakes.
absl::StatusOr<ServerOptions> ToOptions(const v1::ServerConfig& config, int cores,
                                        const SettingSources& sources = {},
                                        std::uint64_t memory_bytes = kUnlimitedMemory);

// The other way round: every setting, those with their defaults too, but for names and files that
// are absent.
v1::ServerConfig ToConfig(const ServerOptions& options);

// "host:port"; an IPv6 host is in brackets, an empty one means every interface.
absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text);
std::string ToString(const ListenAddress& address);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_SERVER_OPTIONS_H_
