#include "server/config/load_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/file.h"
#include "model/base/flag_names.h"
#include "model/base/nearest.h"
#include "model/base/text.h"
#include "model/messages/message_text.h"
#include "server/config/server_options.h"

namespace duet::server::config {
namespace {

constexpr std::size_t kMaxConfigBytes = std::size_t{1} << 20;

CLI::ValidationError Unexpected(const char* flag, absl::string_view expected,
                                absl::string_view got) {
  return CLI::ValidationError(flag,
                              absl::StrCat("expected ", expected, ", got ", base::Quoted(got)));
}

// "model:label=version"
v1::VersionLabel ParseVersionLabel(const std::string& text) {
  const std::vector<std::string> model = absl::StrSplit(text, absl::MaxSplits(':', 1));
  const std::vector<std::string> label = absl::StrSplit(model.back(), absl::MaxSplits('=', 1));
  v1::VersionLabel parsed;
  uint32_t version = 0;
  if (model.size() != 2 || label.size() != 2 || !absl::SimpleAtoi(label[1], &version)) {
    throw Unexpected("--version-label", "model:label=version, such as duet:stable=3", text);
  }
  parsed.set_model(model[0]);
  parsed.set_label(label[0]);
  parsed.set_version(version);
  return parsed;
}

// "model=all", "model=latest:2" or "model=1,3"
v1::VersionPolicy ParseVersionPolicy(const std::string& text) {
  const auto malformed = [&text] {
    return Unexpected("--version-policy",
                      "model=all, model=latest:2 or model=1,3, where the model * is every other",
                      text);
  };
  const std::vector<std::string> parts = absl::StrSplit(text, absl::MaxSplits('=', 1));
  if (parts.size() != 2) throw malformed();
  v1::VersionPolicy policy;
  policy.set_model(parts[0]);
  absl::string_view versions = parts[1];
  if (versions == "all") return policy;
  uint32_t number = 0;
  if (absl::ConsumePrefix(&versions, "latest:")) {
    if (!absl::SimpleAtoi(versions, &number)) throw malformed();
    policy.set_latest(number);
    return policy;
  }
  for (const absl::string_view version : absl::StrSplit(versions, ',')) {
    if (!absl::SimpleAtoi(version, &number)) throw malformed();
    policy.add_versions(number);
  }
  return policy;
}

// The names of --clean-up.
const std::map<std::string, v1::CleanUpPolicy> kCleanUpPolicies = {
    {"auto", v1::CLEAN_UP_POLICY_AUTO},
    {"on", v1::CLEAN_UP_POLICY_ON},
    {"off", v1::CLEAN_UP_POLICY_OFF}};

// The names of --engine and --precision.
const std::map<std::string, v1::Engine> kEngines = {{"cpu", v1::ENGINE_CPU},
                                                    {"torch", v1::ENGINE_TORCH}};
const std::map<std::string, v1::Precision> kPrecisions = {
    {"auto", v1::PRECISION_AUTO}, {"f32", v1::PRECISION_F32}, {"bf16", v1::PRECISION_BF16}};

// The names of --log-format and --log-level.
const std::map<std::string, v1::LogFormat> kLogFormats = {{"json", v1::LOG_FORMAT_JSON},
                                                          {"text", v1::LOG_FORMAT_TEXT}};
const std::map<std::string, v1::LogLevel> kLogLevels = {{"info", v1::LOG_LEVEL_INFO},
                                                        {"warning", v1::LOG_LEVEL_WARNING},
                                                        {"error", v1::LOG_LEVEL_ERROR}};

template <typename Value>
Value Named(const std::map<std::string, Value>& names, const char* flag, const std::string& text,
            const char* expected) {
  const auto named = names.find(text);
  if (named != names.end()) return named->second;
  throw Unexpected(flag, expected, text);
}

// A flag's help with the default that holds without it.
template <typename Value>
std::string Defaulting(absl::string_view help, const Value& value) {
  return absl::StrCat(help, " (default ", value, ")");
}

void AddServingFlags(CLI::App& app, v1::ServerConfig& config) {
  const ServerOptions defaults;
  app.add_option_function<std::string>(
         "--listen", [&](const std::string& value) { config.set_listen(value); },
         Defaulting("gRPC address, host:port", ToString(defaults.listen)))
      ->option_text("ADDRESS");
  app.add_option_function<std::string>(
         "--metrics-listen", [&](const std::string& value) { config.set_metrics_listen(value); },
         Defaulting("address of /metrics, /healthz, /readyz, or \"off\"",
                    ToString(*defaults.metrics_listen)))
      ->option_text("ADDRESS");
  app.add_option_function<std::string>(
         "--model-repository",
         [&](const std::string& value) { config.set_model_repository(value); },
         "folder of checkpoints <name>/<version>/ (default: the embedded checkpoint)")
      ->option_text("DIR");
  app.add_option_function<std::string>(
         "--default-model", [&](const std::string& value) { config.set_default_model(value); },
         "model that answers when a request names none (default: sbu of the embedded ones, of a "
         "repository the first by name)")
      ->option_text("NAME");
  app.add_option_function<std::vector<std::string>>(
         "--version-label",
         [&](const std::vector<std::string>& values) {
           for (const std::string& value : values) {
             *config.add_version_labels() = ParseVersionLabel(value);
           }
         },
         "label of a model version, model:label=version; may be repeated")
      ->option_text("LABEL");
  app.add_option_function<std::vector<std::string>>(
         "--version-policy",
         [&](const std::vector<std::string>& values) {
           for (const std::string& value : values) {
             *config.add_version_policies() = ParseVersionPolicy(value);
           }
         },
         "which versions of a model are served: model=all, model=latest:2, model=1,3; the model * "
         "is every other; may be repeated (default *=all)")
      ->option_text("POLICY");
  app.add_option_function<std::string>(
         "--admin-listen", [&](const std::string& value) { config.set_admin_listen(value); },
         "address of the admin service, host:port, or \"off\" (default off)")
      ->option_text("ADDRESS");
  app.add_flag_function(
      "--reflection,!--no-reflection",
      [&](std::int64_t count) { config.set_reflection(count > 0); },
      Defaulting("gRPC server reflection", defaults.reflection ? "on" : "off"));
  app.add_option_function<std::string>(
         "--clean-up",
         [&](const std::string& value) {
           config.set_clean_up(Named(kCleanUpPolicies, "--clean-up", value, "auto, on or off"));
         },
         "whether followers are cleaned up where a request does not say; auto: those of models "
         "that sample (default auto)")
      ->option_text("auto|on|off");
}

void AddCapacityFlags(CLI::App& app, v1::ServerConfig& config) {
  const ServerOptions defaults;
  app.add_option_function<std::string>(
         "--engine",
         [&](const std::string& value) {
           config.set_engine(Named(kEngines, "--engine", value, "cpu or torch"));
         },
         "what computes the answers: cpu, this project's own kernels; torch, LibTorch by way of "
         "its plug-in (default cpu)")
      ->option_text("cpu|torch");
  app.add_option_function<std::string>(
         "--precision",
         [&](const std::string& value) {
           config.set_precision(Named(kPrecisions, "--precision", value, "auto, f32 or bf16"));
         },
         "how the cpu engine holds weights; auto: bf16 where the processor multiplies it (default "
         "auto)")
      ->option_text("auto|f32|bf16");
  app.add_option_function<uint32_t>(
         "--workers", [&](uint32_t value) { config.set_workers(value); },
         "batches evaluated at the same time (default: the container's cores)")
      ->option_text("N");
  app.add_option_function<uint32_t>(
         "--threads-per-worker", [&](uint32_t value) { config.set_threads_per_worker(value); },
         Defaulting("threads of one evaluation by the torch engine", defaults.engine.threads))
      ->option_text("N");
  app.add_option_function<uint32_t>(
         "--max-calls", [&](uint32_t value) { config.set_max_calls(value); },
         Defaulting("Synthesize calls answered at the same time; fewer where memory is short",
                    defaults.max_calls))
      ->option_text("N");
  app.add_option_function<uint32_t>(
         "--max-queued-windows", [&](uint32_t value) { config.set_max_queued_windows(value); },
         Defaulting("calls waiting for their first window above which new ones are refused",
                    defaults.max_queued_windows))
      ->option_text("N");
  app.add_option_function<uint32_t>(
         "--max-batch-windows", [&](uint32_t value) { config.set_max_batch_windows(value); },
         Defaulting("windows of different calls evaluated together", defaults.max_batch_windows))
      ->option_text("N");
  app.add_option_function<double>(
         "--max-batch-delay-seconds",
         [&](double value) { config.set_max_batch_delay_seconds(value); },
         Defaulting("how long a batch that is not full waits for more",
                    defaults.max_batch_delay_seconds))
      ->option_text("S");
  app.add_option_function<uint64_t>(
         "--memory-limit-bytes", [&](uint64_t value) { config.set_memory_limit_bytes(value); },
         "memory that the server plans with (default: the limit of its control group, or the "
         "machine's memory)")
      ->option_text("BYTES");
  app.add_option_function<uint64_t>(
         "--max-request-bytes", [&](uint64_t value) { config.set_max_request_bytes(value); },
         Defaulting("size of a request; less where memory is short", defaults.max_request_bytes))
      ->option_text("BYTES");
  app.add_option_function<uint64_t>(
         "--max-transport-bytes", [&](uint64_t value) { config.set_max_transport_bytes(value); },
         absl::StrCat("memory of requests being received (default: what memory-limit-bytes allows, "
                      "at most ",
                      kTransportPerRequest, " x max-request-bytes)"))
      ->option_text("BYTES");
  app.add_option_function<uint32_t>(
         "--buffered-frames", [&](uint32_t value) { config.set_buffered_frames(value); },
         Defaulting("finished frames that wait for a slow reader", defaults.buffered_frames))
      ->option_text("N");
  app.add_option_function<double>(
         "--drain-seconds", [&](double value) { config.set_drain_seconds(value); },
         Defaulting("after SIGTERM, go on serving this long while health says NOT_SERVING",
                    defaults.drain_seconds))
      ->option_text("S");
  app.add_option_function<double>(
         "--grace-seconds", [&](double value) { config.set_grace_seconds(value); },
         Defaulting("after that, time for calls to finish", defaults.grace_seconds))
      ->option_text("S");
}

void AddSharingFlags(CLI::App& app, v1::ServerConfig& config) {
  const ServerOptions defaults;
  app.add_option_function<double>(
         "--client-share", [&](double value) { config.set_client_share(value); },
         Defaulting("part of calls, bytes and queue that one client can come to hold, over 0 to 1",
                    defaults.client_share))
      ->option_text("PART");
  app.add_option_function<std::string>(
         "--client-key", [&](const std::string& value) { config.set_client_key(value); },
         "metadata key by which a proxy in front names its client (default: clients are addresses)")
      ->option_text("KEY");
  app.add_option_function<uint64_t>(
         "--max-held-bytes", [&](uint64_t value) { config.set_max_held_bytes(value); },
         absl::StrCat("bytes of the requests of calls being answered (default: what "
                      "memory-limit-bytes allows, at most ",
                      kTransportPerRequest, " x max-request-bytes)"))
      ->option_text("BYTES");
  app.add_option_function<double>(
         "--receive-timeout-seconds",
         [&](double value) { config.set_receive_timeout_seconds(value); },
         Defaulting("how long a request may take to arrive", defaults.receive_timeout_seconds))
      ->option_text("S");
  app.add_option_function<uint32_t>(
         "--max-slow-requests", [&](uint32_t value) { config.set_max_slow_requests(value); },
         "requests that take more than 0.1 s to arrive, at the same time (default: "
         "max-transport-bytes / max-request-bytes / 2)")
      ->option_text("N");
  app.add_option_function<double>(
         "--write-timeout-seconds", [&](double value) { config.set_write_timeout_seconds(value); },
         Defaulting("how long one message of an answer may wait for its reader",
                    defaults.write_timeout_seconds))
      ->option_text("S");
  app.add_option_function<double>(
         "--max-call-seconds", [&](double value) { config.set_max_call_seconds(value); },
         Defaulting("how long a call may last, whatever its deadline", defaults.max_call_seconds))
      ->option_text("S");
  app.add_option_function<double>(
         "--self-check-seconds", [&](double value) { config.set_self_check_seconds(value); },
         Defaulting(
             "how often the server connects to its own port, for /readyz and /healthz; 0: never",
             defaults.self_check_seconds))
      ->option_text("S");
  app.add_option_function<double>(
         "--watchdog-seconds", [&](double value) { config.set_watchdog_seconds(value); },
         "how long a thread may take for one step of its work before the process exits with code "
         "3; "
         "0: for ever (default: max-call-seconds, at least 60)")
      ->option_text("S");
}

void AddSecurityFlags(CLI::App& app, v1::ServerConfig& config) {
  app.add_option_function<std::string>(
         "--tls-certificate-file",
         [&](const std::string& value) { config.set_tls_certificate_file(value); },
         "certificate chain of the server, PEM, read again when it changes (default: plain text)")
      ->option_text("FILE");
  app.add_option_function<std::string>(
         "--tls-key-file", [&](const std::string& value) { config.set_tls_key_file(value); },
         "its private key, PEM")
      ->option_text("FILE");
  app.add_option_function<std::string>(
         "--tls-client-ca-file",
         [&](const std::string& value) { config.set_tls_client_ca_file(value); },
         "authorities that sign clients' certificates, PEM (default: clients need none)")
      ->option_text("FILE");
  app.add_option_function<std::string>(
         "--access-file", [&](const std::string& value) { config.set_access_file(value); },
         "who may call: names, roles, hashed tokens, certificate names and limits, read again when "
         "it changes (default: everybody may synthesise)")
      ->option_text("FILE");
}

void AddObservabilityFlags(CLI::App& app, v1::ServerConfig& config) {
  const ServerOptions defaults;
  app.add_option_function<std::string>(
         "--log-format",
         [&](const std::string& value) {
           config.set_log_format(Named(kLogFormats, "--log-format", value, "json or text"));
         },
         "how the log is written (default json)")
      ->option_text("json|text");
  app.add_option_function<std::string>(
         "--log-level",
         [&](const std::string& value) {
           config.set_log_level(Named(kLogLevels, "--log-level", value, "info, warning or error"));
         },
         "the least grave lines that are written (default info)")
      ->option_text("info|warning|error");
  app.add_option_function<double>(
         "--log-success-ratio", [&](double value) { config.set_log_success_ratio(value); },
         Defaulting("part of successful calls that get a line", defaults.logging.success_ratio))
      ->option_text("RATIO");
  app.add_option_function<uint32_t>(
         "--log-refusals-per-second",
         [&](uint32_t value) { config.set_log_refusals_per_second(value); },
         Defaulting("refused calls of one status code that get a line in a second",
                    defaults.logging.refusals_per_second))
      ->option_text("N");
  app.add_option_function<std::string>(
         "--otlp-endpoint", [&](const std::string& value) { config.set_otlp_endpoint(value); },
         "where spans are sent, http://HOST:PORT or https://HOST:PORT (default: nowhere)")
      ->option_text("URL");
  app.add_option_function<double>(
         "--trace-ratio", [&](double value) { config.set_trace_ratio(value); },
         Defaulting("part of calls without a trace whose spans are sent", defaults.tracing.ratio))
      ->option_text("RATIO");
}

// What flags say.
struct Flags {
  v1::ServerConfig config;
  std::string config_path;
  CommandLine::Task task = CommandLine::Task::kServe;
};

constexpr char kFooter[] = R"(
Every flag but the two --...-config switches may be an environment variable instead: DUET_SERVER_MAX_CALLS=64
for --max-calls 64. Flags win over variables, variables over the file.

Signals: SIGTERM and SIGINT drain and stop, a second one at once. SIGHUP reads labels, policies,
the model repository, certificates and the access file again.
)";

void AddFlags(CLI::App& app, Flags& flags) {
  app.set_version_flag("--version", std::string("duet-server ") + DUET_VERSION);
  app.footer(kFooter);
  app.add_option("--config", flags.config_path,
                 "configuration file: text format of duet.v1.ServerConfig, or JSON; flags win")
      ->option_text("FILE");
  app.add_flag_callback(
      "--check-config", [&flags] { flags.task = CommandLine::Task::kCheckConfig; },
      "check settings and secrets, load every model, say all that is wrong, and leave");
  app.add_flag_callback(
      "--print-config", [&flags] { flags.task = CommandLine::Task::kPrintConfig; },
      "print every setting and where it comes from, and leave");
  AddServingFlags(app, flags.config);
  AddCapacityFlags(app, flags.config);
  AddSharingFlags(app, flags.config);
  AddSecurityFlags(app, flags.config);
  AddObservabilityFlags(app, flags.config);
}

// Flags that ask for something to be done once and so are no settings.
bool IsSetting(const std::string& flag) {
  return flag != "--help" && flag != "--version" && flag != "--check-config" &&
         flag != "--print-config";
}

// A program's flags, fresh: CLI11 keeps what it has parsed.
class FlagParser {
 public:
  FlagParser() : app_("Answers one character's motion with another's, over gRPC.", "duet-server") {
    AddFlags(app_, flags_);
  }
  FlagParser(const FlagParser&) = delete;
  FlagParser& operator=(const FlagParser&) = delete;

  // Fails with INVALID_ARGUMENT and the first mistake. `print` receives what --help and --version
  // print.
  absl::StatusOr<Flags> Parse(int argc, const char* const* argv,
                              std::optional<std::string>* print) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::Success& wanted) {
      std::ostringstream text;
      app_.exit(wanted, text, text);
      *print = text.str();
    } catch (const CLI::ExtrasError&) {
      return NotAFlag(app_.remaining());
    } catch (const CLI::ParseError& error) {
      return absl::InvalidArgumentError(error.what());
    }
    return flags_;
  }

  // One flag of a command line with the words that follow it.
  absl::StatusOr<Flags> ParseOne(std::vector<std::string> words) {
    const std::vector<std::string> parts = absl::StrSplit(words[0], absl::MaxSplits('=', 1));
    const std::string value = parts.size() > 1 ? parts[1] : words.back();
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
      app_.parse(std::move(words));
    } catch (const CLI::Success&) {
    } catch (const CLI::ExtrasError&) {
      return NotAFlag(app_.remaining());
    } catch (const CLI::ParseError& error) {
      return absl::InvalidArgumentError(
          absl::StrCat(parts[0], ": ", Mistake(parts[0], value, error)));
    }
    return flags_;
  }

  // What a variable sets, its value spelt as on the command line.
  absl::StatusOr<Flags> ParseVariable(const std::string& name, const std::string& value) {
    const std::string flag = FlagOfVariable(name);
    const CLI::Option* option = app_.get_option_no_throw(flag);
    if (option == nullptr || !IsSetting(flag)) return UnknownVariable(name);
    std::vector<std::string> values = {value};
    if (option->get_expected_max() > 1) values = absl::StrSplit(value, ' ', absl::SkipEmpty());
    // CLI11 takes the words in reverse. One word, so that a value may begin with a hyphen; CLI11
    // takes an empty value as a word of its own alone.
    std::vector<std::string> words;
    for (const std::string& each : values) {
      if (each.empty()) words.insert(words.end(), {each, flag});
      if (!each.empty()) words.push_back(absl::StrCat(flag, "=", each));
    }
    try {
      app_.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
      return absl::InvalidArgumentError(absl::StrCat(name, ": ", Mistake(flag, value, error)));
    }
    return flags_;
  }

 private:
  // "expected ..., got ..." of a flag's value.
  std::string Mistake(const std::string& flag, const std::string& value,
                      const CLI::ParseError& error) const {
    const CLI::Option* option = app_.get_option_no_throw(flag);
    if (option != nullptr && dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
      const std::string type = option->get_type_name();
      return absl::StrCat("expected ",
                          type == "UINT"    ? "a whole number of 0 or more"
                          : type == "FLOAT" ? "a number"
                                            : "true or false",
                          ", got ", base::Quoted(value));
    }
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
      return "expected a value, got none";
    }
    absl::string_view text = error.what();
    absl::ConsumePrefix(&text, absl::StrCat(flag, ": "));
    return std::string(text);
  }

  // What is left of a command line. A flag's value may be among it, so the flag counts.
  absl::Status NotAFlag(const std::vector<std::string>& words) const {
    std::vector<std::string> known;
    for (const CLI::Option* option : app_.get_options()) {
      for (const std::string& flag : option->get_lnames()) known.push_back("--" + flag);
    }
    for (const std::string& word : words) {
      if (!absl::StartsWith(word, "-")) continue;
      const std::string flag = word.substr(0, word.find('='));
      return absl::InvalidArgumentError(
          absl::StrCat(flag, ": there is no such flag", base::DidYouMean(flag, known)));
    }
    return absl::InvalidArgumentError(
        absl::StrCat("expected flags only, got ", base::Quoted(words[0])));
  }

  absl::Status UnknownVariable(const std::string& name) const {
    std::vector<std::string> known;
    for (const CLI::Option* option : app_.get_options()) {
      for (const std::string& flag : option->get_lnames()) {
        if (!IsSetting(absl::StrCat("--", flag))) continue;
        known.push_back(VariableOfFlag(flag));
      }
    }
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": sets nothing", base::DidYouMean(name, known)));
  }

  Flags flags_;
  CLI::App app_;
};

// The words of a command line, each flag with those that follow it. A negative number is no flag.
std::vector<std::vector<std::string>> SplitFlags(int argc, const char* const* argv) {
  std::vector<std::vector<std::string>> flags;
  for (int i = 1; i < argc; ++i) {
    const absl::string_view word = argv[i];
    const bool is_flag = absl::StartsWith(word, "--") ||
                         (word.size() > 1 && word[0] == '-' && absl::ascii_isalpha(word[1]));
    if (is_flag || flags.empty()) flags.emplace_back();
    flags.back().emplace_back(word);
  }
  return flags;
}

// Puts settings over those that are there. `source` tells of a field where it comes from, by the
// name that it has in its own message.
template <typename Source>
void Override(const v1::ServerConfig& settings, const Source& source, CommandLine* command_line) {
  using google::protobuf::FieldDescriptor;
  const google::protobuf::Reflection& reflection = *settings.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(settings, &fields);
  for (const FieldDescriptor* field : fields) {
    if (!field->is_repeated()) {
      command_line->sources[field->name()] = source(field->name());
      continue;
    }
    const int before = reflection.FieldSize(command_line->config, field);
    for (int i = 0; i < reflection.FieldSize(settings, field); ++i) {
      command_line->sources[absl::StrCat(field->name(), "[", before + i, "]")] =
          source(absl::StrCat(field->name(), "[", i, "]"));
    }
  }
  command_line->config.MergeFrom(settings);
}

void AddErrors(const absl::Status& status, CommandLine* command_line) {
  for (absl::string_view line : absl::StrSplit(status.message(), '\n', absl::SkipEmpty())) {
    command_line->errors.emplace_back(line);
  }
}

// The flags of a command line with mistakes in it: each by itself, so that all mistakes are found
// and the other flags count. `first` is what is wrong with the command line as a whole.
Flags ParseEach(int argc, const char* const* argv, const absl::Status& first,
                CommandLine* command_line) {
  Flags all;
  for (std::vector<std::string>& words : SplitFlags(argc, argv)) {
    const absl::StatusOr<Flags> one = FlagParser().ParseOne(std::move(words));
    AddErrors(one.status(), command_line);
    if (!one.ok()) continue;
    all.config.MergeFrom(one->config);
    if (!one->config_path.empty()) all.config_path = one->config_path;
    if (one->task != CommandLine::Task::kServe) all.task = one->task;
  }
  // Such as a flag that is repeated.
  if (command_line->errors.empty()) AddErrors(first, command_line);
  return all;
}

void ReadFile(const std::string& path, CommandLine* command_line) {
  v1::ServerConfig config;
  messages::FieldPlaces places;
  AddErrors(ReadConfigFile(path, &config, &places), command_line);
  const auto source = [&](const std::string& field) {
    const messages::Place place = places[field];
    return absl::StrCat("file ", path, ":", place.line, ":", place.column);
  };
  Override(config, source, command_line);
}

std::string PrefixLines(absl::string_view prefix, absl::string_view lines) {
  return absl::StrCat(prefix, absl::StrReplaceAll(lines, {{"\n", absl::StrCat("\n", prefix)}}));
}

}  // namespace

absl::StatusOr<v1::ServerConfig> ParseConfigText(std::string_view text, bool json) {
  v1::ServerConfig config;
  const absl::Status status = messages::ParseMessage(
      {text.data(), text.size()},
      json ? messages::MessageSyntax::kJson : messages::MessageSyntax::kTextFormat, &config);
  if (!status.ok()) return status;
  return config;
}

absl::Status ReadConfigFile(const std::filesystem::path& path, v1::ServerConfig* config,
                            messages::FieldPlaces* places) {
  config->Clear();
  const absl::StatusOr<std::string> text = base::ReadFile(path, kMaxConfigBytes, "a configuration");
  if (!text.ok()) {
    return absl::Status(text.status().code(), absl::StrCat("--config: ", text.status().message()));
  }
  const messages::MessageSyntax syntax = path.extension() == ".json"
                                             ? messages::MessageSyntax::kJson
                                             : messages::MessageSyntax::kTextFormat;
  const absl::Status status = messages::ParseMessage(*text, syntax, config, places);
  if (status.ok()) return status;
  return absl::InvalidArgumentError(
      PrefixLines(absl::StrCat("--config: ", path.string(), ": "), status.message()));
}

CommandLine ParseCommandLine(int argc, const char* const* argv, const Environment& environment) {
  CommandLine command_line;
  const base::KebabCaseCommandLine line(argc, argv);
  absl::StatusOr<Flags> flags = FlagParser().Parse(line.argc(), line.argv(), &command_line.print);
  if (command_line.print.has_value()) return command_line;
  if (!flags.ok()) flags = ParseEach(line.argc(), line.argv(), flags.status(), &command_line);
  std::map<std::string, Flags> variables;
  std::string config_path;
  for (const auto& [name, value] : environment) {
    absl::StatusOr<Flags> variable = FlagParser().ParseVariable(name, value);
    AddErrors(variable.status(), &command_line);
    if (!variable.ok()) continue;
    if (!variable->config_path.empty()) config_path = variable->config_path;
    variables[name] = *std::move(variable);
  }
  if (!flags->config_path.empty()) config_path = flags->config_path;
  if (!config_path.empty()) ReadFile(config_path, &command_line);
  for (const auto& [name, variable] : variables) {
    const std::string source = absl::StrCat("environment ", name);
    Override(
        variable.config, [&source](const std::string&) { return source; }, &command_line);
  }
  command_line.task = flags->task;
  Override(
      flags->config, [](const std::string&) { return "command line"; }, &command_line);
  return command_line;
}

Settings ReadSettings(const CommandLine& command_line, int cores, std::uint64_t memory_bytes) {
  Settings settings = ReadSettings(command_line.config, cores, command_line.sources, memory_bytes);
  settings.mistakes.insert(settings.mistakes.begin(), command_line.errors.begin(),
                           command_line.errors.end());
  return settings;
}

absl::StatusOr<ServerOptions> ToOptions(const CommandLine& command_line, int cores,
                                        std::uint64_t memory_bytes) {
  Settings settings = ReadSettings(command_line, cores, memory_bytes);
  if (settings.mistakes.empty()) return std::move(settings.options);
  return absl::InvalidArgumentError(absl::StrJoin(settings.mistakes, "\n"));
}

}  // namespace duet::server::config
