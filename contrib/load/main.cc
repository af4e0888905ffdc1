// duet-load: puts a load on a Duet server and measures how fast it answers.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/time/clock.h"
#include "client/batch/text_values.h"
#include "client/cli/flags.h"
#include "client/cli/server.h"
#include "client/client.h"
#include "client/error_details.h"
#include "contrib/load/report.h"
#include "contrib/load/server_calls.h"
#include "contrib/load/server_sessions.h"
#include "model/base/file.h"
#include "model/base/program_flags.h"
#include "model/base/program_output.h"

namespace duet::contrib::load {
namespace {

namespace cli = client::cli;
namespace fs = std::filesystem;

constexpr double kLiveRate = 30, kLowestLiveRate = 1, kHighestLiveRate = 240;  // frames a second
constexpr char kGroup[] = "Options";                   // CLI11's name of the flags without a group
constexpr absl::Duration kEnding = absl::Seconds(30);  // of live sessions

// The exit codes, which --help explains.
enum ExitCode : int { kDone = 0, kNotAnswered = 1, kBadUsage = 2, kRejected = 42 };

volatile std::sig_atomic_t stopped = 0;

// The first signal ends the run with its report, the second one the process.
void StopAtSignal(int signal) {
  stopped = 1;
  std::signal(signal, SIG_DFL);
}

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
  duet-load --rate 50,100,200 --frames 460 --seconds 30 --json load.json
  duet-load --live 20,50 --rate 60
)";

struct LoadArguments {
  cli::ServerArguments server;
  CallContent content;
  std::vector<int> callers;   // a step each; and
  std::vector<double> rates;  // a step each; neither: one caller. Live: the frames' rate
  CallOptions calls;
  int connections = 1;
  double warm_up_seconds = 1, seconds = 10;
  std::vector<int> sessions;  // live sessions in place of calls; a step each
  LiveOptions live;
  fs::path json;
  bool quiet = false;
};

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
  app->add_option("--warm-up", arguments->warm_up_seconds, "Unmeasured seconds before each step")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str()
      ->type_name("SECONDS");
  app->add_option("--seconds", arguments->seconds, "Measured seconds of each step")
      ->check(CLI::Range(0.1, 864000.0))
      ->capture_default_str()
      ->type_name("SECONDS");
  app->add_option("--connections", arguments->connections, "Connections, which calls use in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->type_name("N");
}

void AddContent(CLI::App* app, LoadArguments* arguments) {
  app->add_option("--frames", arguments->content.frames, "Length of the leader")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str()
      ->type_name("FRAMES");
  cli::AddParsed(app, kGroup, "--model", "NAME[@VERSION]", client::batch::ParseModelChoice,
                 &arguments->content.model, "Also NAME:LABEL (default: the server's)");
  cli::AddParsed(app, kGroup, "--label", "CLASS=WEIGHT,...", client::batch::ParseLabels,
                 &arguments->content.labels, "(default: 1 for the model's first class)");
  app->add_option("--json", arguments->json, "Write everything; - for standard output")
      ->type_name("FILE");
  app->add_flag("--quiet", arguments->quiet, "Do not print the current step");
}

void AddLive(CLI::App* app, LoadArguments* arguments) {
  app->add_option("--live", arguments->sessions,
                  "Live sessions side by side; --rate is then their frames a second, default 30")
      ->delimiter(',')
      ->check(CLI::Range(1, 100000))
      ->excludes(app->get_option("--callers"))
      ->excludes(app->get_option("--frames"))
      ->type_name("N,...");
}

// Runs the steps of a command line.
class LoadRun {
 public:
  // Both outlive the run.
  LoadRun(LoadArguments* arguments, Report* report) : arguments_(*arguments), report_(*report) {
    arguments_.calls.stopped = arguments_.live.stopped = [] { return stopped != 0; };
    arguments_.calls.warm_up = arguments_.live.warm_up = Seconds(arguments_.warm_up_seconds);
    arguments_.calls.measured = arguments_.live.measured = Seconds(arguments_.seconds);
  }

  absl::Status Run() {
    const absl::StatusOr<client::ClientOptions> options = cli::ToClientOptions(arguments_.server);
    if (!options.ok()) return options.status();
    const absl::StatusOr<client::Client> client = client::Client::Create(*options);
    if (!client.ok()) return client.status();
    report_.server = arguments_.server.address;
    report_.time = absl::FormatTime("%Y-%m-%d %H:%M:%S UTC", absl::Now(), absl::UTCTimeZone());
    return arguments_.sessions.empty() ? MeasureCalls(*client, *options)
                                       : MeasureSessions(*client, *options);
  }

 private:
  // Whether a step may begin; says so.
  bool Begins(const std::string& step) {
    if (stopped != 0) return false;
    if (!arguments_.quiet) std::cerr << "duet-load: " << step << std::endl;
    return true;
  }

  absl::Status MeasureCalls(const client::Client& client, const client::ClientOptions& options) {
    const absl::StatusOr<CallRequest> request = FindRequest(client, arguments_.content);
    if (!request.ok()) return request.status();
    report_.model = request->model;
    const absl::StatusOr<std::unique_ptr<CallTarget>> target =
        ConnectCalls(options, arguments_.connections, request->bytes);
    if (!target.ok()) return target.status();
    std::vector<CallLoad> loads;
    for (const double rate : arguments_.rates) loads.push_back({0, rate});
    for (const int callers : arguments_.callers) loads.push_back({callers, 0});
    if (loads.empty()) loads.push_back({1, 0});
    for (const CallLoad& load : loads) {
      if (!Begins(StepName(load))) break;
      report_.calls.push_back(RunCalls(load, arguments_.calls, **target));
    }
    return absl::OkStatus();
  }

  absl::Status MeasureSessions(const client::Client& client, const client::ClientOptions& options) {
    LiveSessions sessions;
    if (absl::Status status = Describe(client, &sessions); !status.ok()) return status;
    arguments_.live.frame_rate_hz = sessions.frame_rate_hz;
    const absl::StatusOr<std::unique_ptr<LiveTarget>> target =
        ConnectSessions(options, arguments_.connections, sessions);
    if (!target.ok()) return target.status();
    for (const int count : arguments_.sessions) {
      if (!Begins(absl::StrCat(count, " live sessions"))) break;
      arguments_.live.sessions = count;
      report_.live.push_back(RunLive(arguments_.live, **target));
    }
    return absl::OkStatus();
  }

  absl::Status Describe(const client::Client& client, LiveSessions* sessions) {
    const double rate = arguments_.rates.empty() ? kLiveRate : arguments_.rates.front();
    if (arguments_.rates.size() > 1 || rate < kLowestLiveRate || rate > kHighestLiveRate) {
      return absl::InvalidArgumentError(
          absl::StrCat("--rate: expected one rate from ", kLowestLiveRate, " to ", kHighestLiveRate,
                       " with --live, got ", absl::StrJoin(arguments_.rates, ",")));
    }
    sessions->content = arguments_.content;
    const absl::StatusOr<client::ModelDetails> details = client.GetModel(sessions->content.model);
    if (!details.ok()) return details.status();
    sessions->model = details->model;
    report_.model = absl::StrCat(details->model.name, "@", details->model.version);
    sessions->frame_rate_hz = rate;
    sessions->longest = absl::Seconds(arguments_.warm_up_seconds + arguments_.seconds) + kEnding;
    return absl::OkStatus();
  }

  LoadArguments& arguments_;
  Report& report_;
};

// JSON on standard output takes the place of the text.
absl::Status Write(const Report& report, const fs::path& json) {
  std::cout << (json == "-" ? ToJson(report) : ToText(report));
  if (absl::Status written = base::FlushOutput(&std::cout); !written.ok()) return written;
  return json.empty() || json == "-" ? absl::OkStatus() : base::WriteFile(json, ToJson(report));
}

int RunLoadProgram(int argc, char** argv) {
  CLI::App app("Puts a load on a Duet server and measures its answers.", "duet-load");
  app.set_version_flag("--version", "duet-load " DUET_VERSION);
  app.footer(kFooter);
  LoadArguments parsed;
  cli::AddServerFlags(&app, &parsed.server);
  // A flag belongs to the group that is the default when it is added.
  app.option_defaults()->group("Load");
  AddLoad(&app, &parsed);
  AddContent(&app, &parsed);
  app.option_defaults()->group("Live sessions");
  AddLive(&app, &parsed);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {  // also --help and --version
    return app.exit(error) == 0 ? kDone : kBadUsage;
  }
  Report report;
  report.program = "duet-load " DUET_VERSION;
  absl::Status status = LoadRun(&parsed, &report).Run();
  if (status.ok()) status = Write(report, parsed.json);
  if (!status.ok()) {
    std::cerr << "duet-load: " << status.message() << " ("
              << absl::StatusCodeToString(status.code()) << ")\n";
    return client::IsPermanent(status) ? kRejected : kNotAnswered;
  }
  if (IsAnswered(report)) return kDone;
  std::cerr << "duet-load: nothing was answered\n";
  return kNotAnswered;
}

}  // namespace
}  // namespace duet::contrib::load

int main(int argc, char** argv) {
  // What goes wrong is in the statuses that are counted.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  std::signal(SIGINT, duet::contrib::load::StopAtSignal);
  std::signal(SIGTERM, duet::contrib::load::StopAtSignal);
  return duet::base::FinishOutput("duet-load", duet::contrib::load::RunLoadProgram(argc, argv));
}
