#include "server/config/server_options.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/printable.h"
#include "server/common/http_origin.h"
#include "server/config/memory_plan.h"

namespace duet::server::config {
namespace {

constexpr std::size_t kLongestFailure = 1000;

// Reads fields one after the other and keeps every failure.
class Reader {
 public:
  explicit Reader(const SettingSources& sources) : sources_(sources) {}

  // The value, or `min` after a failure.
  template <typename T, typename Limit>
  T InRange(absl::string_view field, T value, Limit min, Limit max) {
    // Written so that NaN is out of range.
    if (value >= min && value <= max) return value;
    Fail(field, absl::StrCat(min, " to ", max), absl::StrCat(value));
    return static_cast<T>(min);
  }

  ListenAddress Address(absl::string_view field, const std::string& text) {
    absl::StatusOr<ListenAddress> address = ParseListenAddress(text);
    if (address.ok()) return *std::move(address);
    Fail(absl::StrCat(field, ": ", address.status().message()));
    return {};
  }

  // "field: expected ..., got ... (source); hint"; `got` may quote what came as it is.
  void Fail(absl::string_view field, absl::string_view expected, absl::string_view got,
            absl::string_view hint = "") {
    Fail(absl::StrCat(field, ": expected ", expected, ", got ", got), hint);
  }

  // `message` begins with the field and a colon; it may quote what came as it is.
  void Fail(const std::string& message, absl::string_view hint = "") {
    const auto source = sources_.find(message.substr(0, message.find(':')));
    std::string failure = base::Printable(message, kLongestFailure);
    if (source != sources_.end()) absl::StrAppend(&failure, " (", source->second, ")");
    if (!hint.empty()) absl::StrAppend(&failure, "; ", hint);
    failures_.push_back(std::move(failure));
  }

  std::vector<std::string> Take() { return std::move(failures_); }

 private:
  const SettingSources& sources_;
  std::vector<std::string> failures_;
};

// An address that may be "off".
std::optional<ListenAddress> ReadListen(absl::string_view field, const std::string& text,
                                        Reader& reader) {
  if (text.empty() || text == "off") return std::nullopt;
  return reader.Address(field, text);
}

void ReadEngine(const v1::ServerConfig& config, Reader& reader, EngineOptions& options) {
  using Engine = EngineOptions::Engine;
  using Precision = EngineOptions::Precision;
  if (config.has_engine()) {
    if (config.engine() != v1::ENGINE_CPU && config.engine() != v1::ENGINE_TORCH) {
      reader.Fail("engine", "ENGINE_CPU or ENGINE_TORCH", absl::StrCat(config.engine()));
    }
    options.engine = config.engine() == v1::ENGINE_TORCH ? Engine::kTorch : Engine::kCpu;
  }
  if (!config.has_precision()) return;
  switch (config.precision()) {
    case v1::PRECISION_AUTO:
      break;
    case v1::PRECISION_F32:
      options.precision = Precision::kFloat32;
      break;
    case v1::PRECISION_BF16:
      options.precision = Precision::kBfloat16;
      break;
    default:
      reader.Fail("precision", "PRECISION_AUTO, PRECISION_F32 or PRECISION_BF16",
                  absl::StrCat(config.precision()));
  }
  if (options.engine == Engine::kTorch && options.precision == Precision::kBfloat16) {
    reader.Fail("precision", "PRECISION_F32 with ENGINE_TORCH", "PRECISION_BF16");
  }
}

// More threads than this for each core would only take turns; hundreds of them take the machine a
// minute to start. Small machines may have some to try things with.
constexpr int kThreadsPerCore = 4;
constexpr int kThreadsAnywhere = 32;

void CheckThreads(int cores, bool workers_given, Reader& reader, const ServerOptions& options) {
  const int most = std::max(kThreadsAnywhere, kThreadsPerCore * cores);
  if (options.workers * options.engine.threads <= most) return;
  const bool workers_alone = options.engine.threads == 1;
  if (workers_given && workers_alone) {
    reader.Fail("workers", absl::StrCat("1 to ", most, " on ", cores, " cores"),
                absl::StrCat(options.workers));
    return;
  }
  reader.Fail("threads_per_worker",
              absl::StrCat("1 to ", std::max(1, most / options.workers), " with ", options.workers,
                           " workers"),
              absl::StrCat(options.engine.threads),
              absl::StrCat("together they may have ", most, " threads on ", cores, " cores"));
}

// With nothing else said, one-thread workers on every core: evaluations of one window gain less
// from a second thread than from a second window. LibTorch can use more: then, with one of the two
// given, the other uses up the cores.
void ReadThreads(const v1::ServerConfig& config, int cores, Reader& reader,
                 ServerOptions& options) {
  constexpr uint32_t kMax = 1024;
  const bool one_thread = options.engine.engine == EngineOptions::Engine::kCpu;
  int& threads = options.engine.threads;
  if (config.has_workers()) {
    options.workers =
        static_cast<int>(reader.InRange("workers", config.workers(), uint32_t{1}, kMax));
  }
  if (config.has_threads_per_worker()) {
    threads = static_cast<int>(
        reader.InRange("threads_per_worker", config.threads_per_worker(), uint32_t{1}, kMax));
    if (one_thread && threads > 1) {
      reader.Fail("threads_per_worker", "1 with ENGINE_CPU", absl::StrCat(threads),
                  "its evaluations have one thread each: more workers use more cores");
      threads = 1;
    }
  }
  if (!config.has_workers()) options.workers = std::max(1, cores / threads);
  if (!config.has_threads_per_worker() && !one_thread) {
    threads = std::max(1, cores / options.workers);
  }
  CheckThreads(cores, config.has_workers(), reader, options);
}

void ReadLimits(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  constexpr uint32_t kOne = 1;
  if (config.has_max_calls()) {
    options.max_calls =
        static_cast<int>(reader.InRange("max_calls", config.max_calls(), kOne, 100000U));
  }
  if (config.has_max_queued_windows()) {
    options.max_queued_windows = static_cast<int>(
        reader.InRange("max_queued_windows", config.max_queued_windows(), kOne, 100000U));
  }
  if (config.has_max_request_bytes()) {
    // Twice this is gRPC's own limit, an int.
    options.max_request_bytes = static_cast<std::size_t>(reader.InRange(
        "max_request_bytes", config.max_request_bytes(), uint64_t{1024}, uint64_t{1} << 29));
  }
  if (config.has_buffered_frames()) {
    options.buffered_frames = static_cast<int>(
        reader.InRange("buffered_frames", config.buffered_frames(), kOne, 1000000U));
  }
  if (config.has_drain_seconds()) {
    options.drain_seconds = reader.InRange("drain_seconds", config.drain_seconds(), 0, 3600);
  }
  if (config.has_grace_seconds()) {
    options.grace_seconds = reader.InRange("grace_seconds", config.grace_seconds(), 0, 3600);
  }
}

// Whether a call's metadata may hold text under this key.
bool IsMetadataKey(absl::string_view key) {
  return !absl::EndsWith(key, "-bin") && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '-' || c == '_' || c == '.';
  });
}

// After ReadMemory: some defaults follow from the sizes there.
void ReadSharing(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  constexpr double kHour = 3600;
  if (config.has_client_share()) {
    options.client_share = reader.InRange("client_share", config.client_share(), 0.01, 1.0);
  }
  options.client_key = config.client_key();
  if (!options.client_key.empty() && !IsMetadataKey(options.client_key)) {
    reader.Fail("client_key", "lower-case letters, digits, '-', '_' and '.', not ending in -bin",
                absl::StrCat("\"", options.client_key, "\""));
  }
  options.max_slow_requests =
      config.has_max_slow_requests()
          ? static_cast<int>(reader.InRange("max_slow_requests", config.max_slow_requests(),
                                            uint32_t{1}, uint32_t{100000}))
          : static_cast<int>(std::clamp<std::size_t>(
                options.max_transport_bytes / (2 * options.max_request_bytes), 1, 100000));
  if (config.has_receive_timeout_seconds()) {
    options.receive_timeout_seconds =
        reader.InRange("receive_timeout_seconds", config.receive_timeout_seconds(), 0.1, kHour);
  }
  if (config.has_write_timeout_seconds()) {
    options.write_timeout_seconds =
        reader.InRange("write_timeout_seconds", config.write_timeout_seconds(), 0.1, kHour);
  }
  if (config.has_max_call_seconds()) {
    options.max_call_seconds =
        reader.InRange("max_call_seconds", config.max_call_seconds(), 1.0, 24 * kHour);
  }
  if (config.has_self_check_seconds()) {
    options.self_check_seconds =
        reader.InRange("self_check_seconds", config.self_check_seconds(), 0.0, kHour);
  }
}

// After ReadSharing: the default follows from max_call_seconds.
void ReadWatchdog(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  // A step takes milliseconds, parsing the largest request half a second.
  constexpr double kShortest = 1;
  constexpr double kShortestDefault = 60;
  constexpr double kLongest = 24 * 3600;
  const double seconds = config.has_watchdog_seconds()
                             ? config.watchdog_seconds()
                             : std::max(options.max_call_seconds, kShortestDefault);
  // Written so that NaN is out of range.
  if (seconds == 0 || (seconds >= kShortest && seconds <= kLongest)) {
    options.watchdog_seconds = seconds;
  } else {
    reader.Fail("watchdog_seconds", absl::StrCat("0, or ", kShortest, " to ", kLongest),
                absl::StrCat(seconds));
  }
}

// After ReadThreads and ReadLimits.
void ReadMemory(const v1::ServerConfig& config, std::uint64_t memory_bytes, Reader& reader,
                ServerOptions& options) {
  constexpr uint64_t kMost = uint64_t{1} << 40;
  options.memory_limit_bytes =
      config.has_memory_limit_bytes()
          ? reader.InRange("memory_limit_bytes", config.memory_limit_bytes(), uint64_t{64} << 20,
                           kUnlimitedMemory)
          : memory_bytes;
  FitCallsToMemory(config, &options);
  if (config.has_max_transport_bytes()) {
    options.max_transport_bytes = reader.InRange(
        "max_transport_bytes", config.max_transport_bytes(), 2 * options.max_request_bytes, kMost);
  }
  if (config.has_max_held_bytes()) {
    options.max_held_bytes = reader.InRange("max_held_bytes", config.max_held_bytes(),
                                            uint64_t{options.max_request_bytes}, kMost);
  }
  FitBytesToMemory(config, &options);
}

void ReadBatching(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  if (config.has_max_batch_windows()) {
    options.max_batch_windows = static_cast<int>(reader.InRange(
        "max_batch_windows", config.max_batch_windows(), uint32_t{1}, uint32_t{1024}));
  }
  if (config.has_max_batch_delay_seconds()) {
    options.max_batch_delay_seconds =
        reader.InRange("max_batch_delay_seconds", config.max_batch_delay_seconds(), 0, 1);
  }
}

void ReadCleanUp(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  if (!config.has_clean_up()) return;
  switch (config.clean_up()) {
    case v1::CLEAN_UP_POLICY_AUTO:
      break;
    case v1::CLEAN_UP_POLICY_ON:
      options.clean_up = true;
      break;
    case v1::CLEAN_UP_POLICY_OFF:
      options.clean_up = false;
      break;
    default:
      reader.Fail("clean_up", "CLEAN_UP_POLICY_AUTO, CLEAN_UP_POLICY_ON or CLEAN_UP_POLICY_OFF",
                  absl::StrCat(config.clean_up()));
  }
}

void ReadSecurity(const v1::ServerConfig& config, Reader& reader, SecurityOptions& options) {
  options.tls_certificate_file = config.tls_certificate_file();
  options.tls_key_file = config.tls_key_file();
  options.tls_client_ca_file = config.tls_client_ca_file();
  options.access_file = config.access_file();
  if (options.tls_certificate_file.empty() != options.tls_key_file.empty()) {
    const bool no_key = options.tls_key_file.empty();
    reader.Fail(no_key ? "tls_key_file" : "tls_certificate_file",
                absl::StrCat("a file beside ", no_key ? "tls_certificate_file" : "tls_key_file"),
                "none", "encryption takes both, plain text neither");
  }
  if (!options.tls_client_ca_file.empty() && options.tls_certificate_file.empty()) {
    reader.Fail("tls_client_ca_file", "tls_certificate_file and tls_key_file beside it", "neither",
                "only an encrypted connection can ask clients for certificates");
  }
}

void ReadLogging(const v1::ServerConfig& config, Reader& reader, LoggingOptions& options) {
  if (config.has_log_format()) {
    if (config.log_format() != v1::LOG_FORMAT_JSON && config.log_format() != v1::LOG_FORMAT_TEXT) {
      reader.Fail("log_format", "LOG_FORMAT_JSON or LOG_FORMAT_TEXT",
                  absl::StrCat(config.log_format()));
    }
    options.format = config.log_format() == v1::LOG_FORMAT_TEXT ? LoggingOptions::Format::kText
                                                                : LoggingOptions::Format::kJson;
  }
  if (config.has_log_level()) {
    if (config.log_level() < v1::LOG_LEVEL_INFO || config.log_level() > v1::LOG_LEVEL_ERROR) {
      reader.Fail("log_level", "LOG_LEVEL_INFO, LOG_LEVEL_WARNING or LOG_LEVEL_ERROR",
                  absl::StrCat(config.log_level()));
    }
    options.level = config.log_level() == v1::LOG_LEVEL_ERROR     ? LoggingOptions::Level::kError
                    : config.log_level() == v1::LOG_LEVEL_WARNING ? LoggingOptions::Level::kWarning
                                                                  : LoggingOptions::Level::kInfo;
  }
  if (config.has_log_success_ratio()) {
    options.success_ratio = reader.InRange("log_success_ratio", config.log_success_ratio(), 0, 1);
  }
  if (config.has_log_refusals_per_second()) {
    options.refusals_per_second = static_cast<int>(reader.InRange(
        "log_refusals_per_second", config.log_refusals_per_second(), uint32_t{0}, 1000000U));
  }
}

void ReadTracing(const v1::ServerConfig& config, Reader& reader, TracingOptions& options) {
  options.otlp_endpoint = config.otlp_endpoint();
  if (!options.otlp_endpoint.empty()) {
    const absl::Status status = common::ParseHttpOrigin(options.otlp_endpoint).status();
    if (!status.ok()) reader.Fail(absl::StrCat("otlp_endpoint: ", status.message()));
  }
  if (config.has_trace_ratio()) {
    options.ratio = reader.InRange("trace_ratio", config.trace_ratio(), 0, 1);
  }
}

void ReadLabels(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  for (int i = 0; i < config.version_labels_size(); ++i) {
    const v1::VersionLabel& label = config.version_labels(i);
    if (label.model().empty() || label.label().empty() || label.version() == 0) {
      reader.Fail(absl::StrCat("version_labels[", i, "]"),
                  "a model, a label and a version of 1 or more",
                  absl::StrCat("model \"", label.model(), "\", label \"", label.label(),
                               "\", version ", label.version()));
    }
    options.version_labels.push_back({label.model(), label.label(), label.version()});
  }
}

void ReadPolicies(const v1::ServerConfig& config, Reader& reader, ServerOptions& options) {
  std::set<std::string> models;
  for (int i = 0; i < config.version_policies_size(); ++i) {
    const v1::VersionPolicy& message = config.version_policies(i);
    const std::string field = absl::StrCat("version_policies[", i, "]");
    VersionPolicyOption policy;
    if (message.model() != "*") policy.model = message.model();
    if (message.has_latest()) policy.latest = message.latest();
    policy.versions.assign(message.versions().begin(), message.versions().end());
    const bool has_zero = std::count(policy.versions.begin(), policy.versions.end(), 0u) > 0;
    if (message.model().empty()) {
      reader.Fail(field, "a model's name, or \"*\" for every other", "none");
    } else if (!models.insert(policy.model).second) {
      reader.Fail(field, "one policy for each model",
                  absl::StrCat("a second of model \"", message.model(), "\""));
    } else if (policy.latest.has_value() && !policy.versions.empty()) {
      reader.Fail(field, "either latest or versions", "both");
    } else if (policy.latest == 0u || has_zero) {
      reader.Fail(field, "numbers of 1 or more", "0");
    }
    options.version_policies.push_back(std::move(policy));
  }
}

bool IsAnyHost(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

bool IsLoopback(const std::string& host) { return host == "127.0.0.1" || host == "::1"; }

// Whether two listeners would be in each other's way.
bool Clash(const ListenAddress& a, const ListenAddress& b) {
  if (a.port != b.port || a.port == 0) return false;
  const bool local = (a.host == "localhost" && IsLoopback(b.host)) ||
                     (b.host == "localhost" && IsLoopback(a.host));
  return a.host == b.host || IsAnyHost(a.host) || IsAnyHost(b.host) || local;
}

// Each listener has a port of its own.
void CheckListeners(const ServerOptions& options, Reader& reader) {
  const std::vector<std::pair<absl::string_view, std::optional<ListenAddress>>> listeners = {
      {"listen", options.listen},
      {"metrics_listen", options.metrics_listen},
      {"admin_listen", options.admin_listen}};
  for (std::size_t i = 0; i < listeners.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& [field, address] = listeners[i];
      const auto& [other_field, other] = listeners[j];
      if (!address.has_value() || !other.has_value() || !Clash(*address, *other)) continue;
      reader.Fail(field, absl::StrCat("another port than ", other_field), ToString(*address),
                  absl::StrCat(other_field, " is ", ToString(*other),
                               "; port 0 is any free one, \"off\" none"));
    }
  }
}

}  // namespace

Settings ReadSettings(const v1::ServerConfig& config, int cores, const SettingSources& sources,
                      std::uint64_t memory_bytes) {
  Reader reader(sources);
  ServerOptions options;
  if (config.has_listen()) options.listen = reader.Address("listen", config.listen());
  if (config.has_metrics_listen()) {
    options.metrics_listen = ReadListen("metrics_listen", config.metrics_listen(), reader);
  }
  options.admin_listen = ReadListen("admin_listen", config.admin_listen(), reader);
  options.model_repository = config.model_repository();
  options.default_model = config.default_model();
  if (config.has_reflection()) options.reflection = config.reflection();
  ReadCleanUp(config, reader, options);
  ReadSecurity(config, reader, options.security);
  ReadLogging(config, reader, options.logging);
  ReadTracing(config, reader, options.tracing);
  ReadLabels(config, reader, options);
  ReadPolicies(config, reader, options);
  ReadEngine(config, reader, options.engine);
  ReadThreads(config, cores, reader, options);
  ReadLimits(config, reader, options);
  ReadMemory(config, memory_bytes, reader, options);
  ReadSharing(config, reader, options);
  ReadWatchdog(config, reader, options);
  ReadBatching(config, reader, options);
  CheckListeners(options, reader);
  return {std::move(options), reader.Take()};
}

absl::StatusOr<ServerOptions> ToOptions(const v1::ServerConfig& config, int cores,
                                        const SettingSources& sources, std::uint64_t memory_bytes) {
  Settings settings = ReadSettings(config, cores, sources, memory_bytes);
  if (settings.mistakes.empty()) return std::move(settings.options);
  return absl::InvalidArgumentError(absl::StrJoin(settings.mistakes, "\n"));
}

absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text) {
  const absl::Status malformed = absl::InvalidArgumentError(absl::StrCat(
      "expected host:port, such as 0.0.0.0:50051, with a port of 0 to 65535, got \"", text, "\""));
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return malformed;
  ListenAddress address;
  absl::string_view host(text.data(), colon);
  const bool bracketed = absl::ConsumePrefix(&host, "[") && absl::ConsumeSuffix(&host, "]");
  if (!bracketed && absl::StrContains(host, ":")) return malformed;
  address.host = host.empty() ? "0.0.0.0" : std::string(host);
  const absl::string_view port = absl::string_view(text).substr(colon + 1);
  if (!absl::SimpleAtoi(port, &address.port) || address.port < 0 || address.port > 65535) {
    return malformed;
  }
  return address;
}

std::string ToString(const ListenAddress& address) {
  const bool ipv6 = absl::StrContains(address.host, ":");
  return absl::StrCat(ipv6 ? "[" : "", address.host, ipv6 ? "]" : "", ":", address.port);
}

}  // namespace duet::server::config
