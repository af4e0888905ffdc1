#include "contrib/load/program/load_flags.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/base/file.h"
#include "model/base/text.h"

namespace duet::contrib::load::program {
namespace {

constexpr char kServerGroup[] = "Server", kLoadGroup[] = "Load", kLiveGroup[] = "Live sessions",
               kCallGroup[] = "Calls", kOutputGroup[] = "Output";

const std::map<std::string, ArrivalKind> kArrivals = {{"poisson", ArrivalKind::kPoisson},
                                                      {"constant", ArrivalKind::kConstant}};
const std::map<std::string, client::Priority> kPriorities = {
    {"interactive", client::Priority::kInteractive}, {"bulk", client::Priority::kBulk}};

constexpr char kFooter[] = R"(
Measures a server under load: callers that each call again after an answer (--callers), calls at a
rate that is independent of the answers (--rate), or live sessions that send a frame whenever a
camera would (--live). Several values make several steps. Every time runs from when a call or a
frame was due. Calls are not retried, and sessions not resumed.

Exit codes:
  0   done
  1   no call and no session was answered
  2   the command line is invalid
  42  the server rejects the calls, or a file cannot be written

Examples:
  duet-load --server lab:50051 --callers 1,8,64
  duet-load --rate 50,100,200 --frames 46=9,460 --seconds 30 --html load.html
  duet-load --live 20,50 --leader samples/hug.bvh --jitter 15 --loss 0.01 --html live.html
)";

absl::Status Expected(absl::string_view expected, absl::string_view text) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(text)));
}

// A list of values with optional weights; `parse` reads a value.
template <typename T, typename Parse>
absl::StatusOr<std::vector<Weighted<T>>> ParseMix(absl::string_view text, const Parse& parse) {
  std::vector<Weighted<T>> mix;
  for (const absl::string_view part : absl::StrSplit(text, ',')) {
    const std::size_t equals = part.find('=');
    absl::StatusOr<T> value = parse(part.substr(0, equals));
    if (!value.ok()) return value.status();
    double weight = 1;
    if (equals != absl::string_view::npos &&
        (!base::ParseNumber(part.substr(equals + 1), &weight) || weight <= 0)) {
      return Expected("a weight above 0 after the =, such as 46=9,460", part);
    }
    mix.push_back({*std::move(value), weight});
  }
  return mix;
}

absl::StatusOr<int> ParseFrameCount(absl::string_view text) {
  int frames = 0;
  if (base::ParseInteger(text, &frames) && frames >= 1) return frames;
  return Expected("numbers of frames, 1 or more, such as 46=9,460", text);
}

absl::StatusOr<client::ModelChoice> ParseModel(absl::string_view text) {
  const std::size_t mark = text.find_first_of("@:");
  client::ModelChoice choice;
  choice.name = std::string(text.substr(0, mark));
  bool valid = !choice.name.empty();
  if (mark != absl::string_view::npos && text[mark] == ':') {
    choice.version_label = std::string(text.substr(mark + 1));
    valid = valid && !choice.version_label.empty();
  } else if (mark != absl::string_view::npos) {
    valid = valid && base::ParseInteger(text.substr(mark + 1), &choice.version.emplace()) &&
            *choice.version >= 1;
  }
  if (valid) return choice;
  return Expected("NAME, NAME@VERSION or NAME:LABEL", text);
}

absl::StatusOr<client::ClassWeight> ParseLabel(absl::string_view text) {
  const std::size_t equals = text.find('=');
  client::ClassWeight label{std::string(text.substr(0, equals)), 1};
  if (!label.interaction_class.empty() &&
      (equals == absl::string_view::npos ||
       absl::SimpleAtof(text.substr(equals + 1), &label.weight))) {
    return label;
  }
  return Expected("CLASS or CLASS=WEIGHT such as kick=0.5", text);
}

// A repeatable flag whose values `parse` reads, one after the other, for `sink`.
template <typename T>
CLI::Option* AddParsed(CLI::App* app, const std::string& name,
                       absl::StatusOr<T> (*parse)(absl::string_view), std::function<void(T)> sink,
                       const std::string& help) {
  const auto read = [name, parse, sink = std::move(sink)](const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      absl::StatusOr<T> parsed = parse(value);
      if (!parsed.ok()) throw CLI::ValidationError(name, std::string(parsed.status().message()));
      sink(*std::move(parsed));
    }
  };
  return app->add_option_function<std::vector<std::string>>(name, read, help)
      ->allow_extra_args(false);
}

// A flag with one of a few names. `names` outlives the app.
template <typename T>
CLI::Option* AddChoice(CLI::App* app, const std::string& name,
                       const std::map<std::string, T>& names, T* target, const std::string& help) {
  const auto read = [&names, target](const std::string& chosen) { *target = names.at(chosen); };
  return app->add_option_function<std::string>(name, read, help)->check(CLI::IsMember(&names));
}

void AddServer(CLI::App* app, ServerArguments* server) {
  app->add_option("--server", server->address,
                  "Server, or any gRPC target such as unix:/run/duet.sock")
      ->envname("DUET_SERVER")
      ->capture_default_str()
      ->type_name("HOST:PORT");
  app->add_flag("--tls", server->tls, "Encrypt; trust the certificate authorities of the system");
  app->add_option("--tls-ca", server->tls_ca_file, "Encrypt; trust the authorities in this file")
      ->type_name("FILE");
  CLI::Option* certificate =
      app->add_option("--tls-cert", server->tls_certificate_file, "Certificate of this client")
          ->type_name("FILE");
  CLI::Option* key =
      app->add_option("--tls-key", server->tls_key_file, "Private key of this client")
          ->type_name("FILE");
  certificate->needs(key);
  key->needs(certificate);
  app->add_option("--tls-server-name", server->tls_server_name,
                  "Name in the server's certificate, if it differs from the address")
      ->type_name("NAME");
  app->add_option("--token-file", server->token_file,
                  "Token that identifies the caller; only sent encrypted or to this machine")
      ->type_name("FILE");
  app->add_option("--authority", server->authority,
                  "Name of the server that a proxy routes by, if it differs from the address")
      ->type_name("NAME");
}

void AddLoad(CLI::App* app, LoadArguments* arguments) {
  CLI::Option* callers =
      app->add_option("--callers", arguments->callers,
                      "Concurrent callers; each calls again after an answer (default: 1)")
          ->delimiter(',')
          ->check(CLI::Range(1, 100000))
          ->type_name("N,...");
  app->add_option("--rate", arguments->rates, "Calls a second, independent of the answers")
      ->delimiter(',')
      ->check(CLI::Range(0.001, 1e6))
      ->excludes(callers)
      ->type_name("HZ,...");
  AddChoice(app, "--arrivals", kArrivals, &arguments->arrivals,
            "Gaps between the calls of a rate: random (poisson) or constant")
      ->default_str("poisson");
  app->add_option("--warm-up", arguments->warm_up_seconds, "Unmeasured seconds before each step")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str()
      ->type_name("SECONDS");
  CLI::Option* seconds =
      app->add_option("--seconds", arguments->seconds, "Measured seconds of each step")
          ->check(CLI::Range(0.1, 864000.0))
          ->capture_default_str()
          ->type_name("SECONDS");
  app->add_option("--calls", arguments->calls, "Number of measured calls, in place of --seconds")
      ->check(CLI::Range(int64_t{1}, int64_t{1000000000}))
      ->excludes(seconds)
      ->type_name("N");
  app->add_option("--connections", arguments->connections, "Connections, which calls use in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  app->add_option("--max-in-flight", arguments->max_in_flight,
                  "Maximum calls in flight with --rate; further calls are sent late, and reported")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->type_name("N");
  app->add_option("--seed", arguments->seed,
                  "Seed of arrivals and requests: the same seed gives the same load")
      ->capture_default_str()
      ->type_name("SEED");
  CLI::Option* background = app->add_option("--background-callers", arguments->background_callers,
                                            "Callers that call continuously and are not measured")
                                ->check(CLI::Range(0, 100000))
                                ->capture_default_str()
                                ->type_name("N");
  app->add_option("--background-frames", arguments->background_frames, "Frames of their leaders")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str()
      ->needs(background)
      ->type_name("FRAMES");
  AddParsed<client::ModelChoice>(
      app, "--background-model", ParseModel,
      [arguments](client::ModelChoice model) { arguments->background_model = std::move(model); },
      "Their model (default: the first measured one)")
      ->needs(background)
      ->type_name("MODEL");
}

void AddCalls(CLI::App* app, LoadArguments* arguments) {
  AddParsed<std::vector<Weighted<int>>>(
      app, "--frames", ParseFrames,
      [arguments](std::vector<Weighted<int>> frames) { arguments->mix.frames = std::move(frames); },
      "Lengths of the leaders, drawn by weight")
      ->default_str(absl::StrCat(arguments->mix.frames.front().value))
      ->type_name("FRAMES[=WEIGHT],...");
  AddParsed<std::vector<Weighted<client::ModelChoice>>>(
      app, "--model", ParseModels,
      [arguments](std::vector<Weighted<client::ModelChoice>> models) {
        arguments->mix.models = std::move(models);
      },
      "NAME, NAME@VERSION or NAME:LABEL, drawn by weight (default: the server's)")
      ->type_name("MODEL[=WEIGHT],...");
  AddParsed<client::ClassWeight>(
      app, "--label", ParseLabel,
      [arguments](client::ClassWeight label) { arguments->mix.labels.push_back(std::move(label)); },
      "Repeatable (default: 1 for the model's first class)")
      ->type_name("CLASS[=WEIGHT]");
  AddChoice(app, "--priority", kPriorities, &arguments->mix.priority, "Priority of the calls")
      ->default_str("interactive");
  app->add_option("--deadline", arguments->server.deadline_seconds, "Deadline of each call")
      ->check(CLI::Range(0.001, 86400.0))
      ->capture_default_str()
      ->type_name("SECONDS");
}

// A flag in milliseconds.
CLI::Option* AddMilliseconds(CLI::App* app, const char* name, Duration* time, const char* help) {
  const auto read = [time](double milliseconds) { *time = Seconds(milliseconds / 1000); };
  return app->add_option_function<double>(name, read, help)
      ->check(CLI::Range(0.0, 60000.0))
      ->type_name("MS");
}

void AddLive(CLI::App* app, LoadArguments* arguments) {
  CLI::Option* live =
      app->add_option(
             "--live", arguments->live,
             "Live sessions side by side; --rate is then their frames a second, default 30")
          ->delimiter(',')
          ->check(CLI::Range(1, 100000))
          ->type_name("N,...");
  for (const char* other :
       {"--callers", "--calls", "--arrivals", "--max-in-flight", "--background-callers", "--frames",
        "--priority", "--csv", "--records"}) {
    live->excludes(app->get_option(other));
  }
  app->add_option(
         "--leader", arguments->leaders,
         "Motion file of a leader, which plays forwards and backwards; repeatable: sessions "
         "take them in turn (default: a generated one)")
      ->check(CLI::ExistingFile)
      ->needs(live)
      ->allow_extra_args(false)
      ->type_name("FILE");
  app->add_option("--delay", arguments->live_content.delay_frames,
                  "Later leader frames that the server waits for")
      ->check(CLI::Range(0, 10))
      ->capture_default_str()
      ->needs(live)
      ->type_name("FRAMES");
  app->add_option("--plan", arguments->live_content.plan_frames,
                  "Provisional frames in each message")
      ->check(CLI::Range(0, 30))
      ->capture_default_str()
      ->needs(live)
      ->type_name("FRAMES");
  LiveConditions* conditions = &arguments->live_conditions;
  AddMilliseconds(app, "--jitter", &conditions->jitter,
                  "Send each frame up to this long after it was due")
      ->needs(live);
  app->add_option("--loss", conditions->loss, "Share of the frames that are never sent")
      ->check(CLI::Range(0.0, 0.9))
      ->needs(live)
      ->type_name("SHARE");
  AddMilliseconds(app, "--stall", &conditions->stall,
                  "Once in each session: send nothing for this long, then everything held back")
      ->needs(live);
  app->add_flag("--in-step", arguments->in_step, "Send the frames of all sessions at the same time")
      ->needs(live);
}

void AddOutputs(CLI::App* app, LoadArguments* arguments) {
  app->add_option("--html", arguments->html, "Write a page with tables and charts")
      ->type_name("FILE");
  app->add_option("--csv", arguments->csv, "Write a row for each step")->type_name("FILE");
  app->add_option("--json", arguments->json, "Write everything; - for standard output")
      ->type_name("FILE");
  app->add_option("--records", arguments->records, "Write a CSV row for each call")
      ->type_name("FILE");
  app->add_option("--title", arguments->title, "Title of the report")->type_name("TEXT");
  app->add_flag("--quiet", arguments->quiet, "Do not print the current step");
}

// The content of a file that is not empty; "" if `path` is empty.
absl::StatusOr<std::string> ReadCredential(const std::string& path, absl::string_view what) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
  if (path.empty()) return std::string();
  absl::StatusOr<std::string> content = base::ReadFile(path, kMaxBytes, what);
  if (!content.ok() || !content->empty()) return content;
  return absl::InvalidArgumentError(absl::StrCat(path, ": expected ", what, ", got an empty file"));
}

}  // namespace

std::vector<Step> LoadArguments::Steps() const {
  std::vector<Step> steps;
  for (const double rate : rates) steps.push_back({0, rate});
  for (const int count : callers) steps.push_back({count, 0});
  if (steps.empty()) steps.push_back({1, 0});
  return steps;
}

double LoadArguments::LiveRate() const {
  return rates.empty() ? LiveOptions().frame_rate_hz : rates.front();
}

void AddLoadFlags(CLI::App* app, LoadArguments* arguments) {
  app->footer(kFooter);
  // A flag belongs to the group that is the default when it is added.
  app->option_defaults()->group(kServerGroup);
  AddServer(app, &arguments->server);
  app->option_defaults()->group(kLoadGroup);
  AddLoad(app, arguments);
  app->option_defaults()->group(kCallGroup);
  AddCalls(app, arguments);
  app->option_defaults()->group(kOutputGroup);
  AddOutputs(app, arguments);
  app->option_defaults()->group(kLiveGroup);
  AddLive(app, arguments);
}

std::vector<std::pair<std::string, std::string>> GivenFlags(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* flag : app.get_options()) {
    if (flag->count() > 0)
      given.emplace_back(flag->get_single_name(), absl::StrJoin(flag->results(), ","));
  }
  return given;
}

absl::StatusOr<client::ClientOptions> ToClientOptions(const ServerArguments& arguments) {
  client::ClientOptions options;
  options.server_address = arguments.address;
  options.deadline = absl::Seconds(arguments.deadline_seconds);
  options.authority = arguments.authority;
  const absl::StatusOr<std::string> token = ReadCredential(arguments.token_file, "a token"),
                                    ca = ReadCredential(arguments.tls_ca_file, "PEM"),
                                    certificate =
                                        ReadCredential(arguments.tls_certificate_file, "PEM"),
                                    key = ReadCredential(arguments.tls_key_file, "PEM");
  for (const absl::StatusOr<std::string>* read : {&token, &ca, &certificate, &key}) {
    if (!read->ok()) return read->status();
  }
  options.token = std::string(absl::StripAsciiWhitespace(*token));
  if (arguments.tls || !ca->empty() || !certificate->empty() ||
      !arguments.tls_server_name.empty()) {
    options.tls = client::TlsOptions{*ca, *certificate, *key, arguments.tls_server_name};
  }
  return options;
}

absl::StatusOr<std::vector<Weighted<int>>> ParseFrames(absl::string_view text) {
  return ParseMix<int>(text, ParseFrameCount);
}

absl::StatusOr<std::vector<Weighted<client::ModelChoice>>> ParseModels(absl::string_view text) {
  return ParseMix<client::ModelChoice>(text, ParseModel);
}

}  // namespace duet::contrib::load::program
