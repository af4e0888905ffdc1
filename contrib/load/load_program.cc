#include "contrib/load/load_program.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <ostream>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/time/clock.h"
#include "client/batch/text_values.h"
#include "client/cli/flags.h"
#include "client/cli/server.h"
#include "client/client.h"
#include "client/error_details.h"
#include "client/model_skeleton.h"
#include "contrib/load/report.h"
#include "contrib/load/server_calls.h"
#include "contrib/load/server_sessions.h"
#include "model/base/file.h"
#include "model/base/program_flags.h"
#include "model/base/program_output.h"
#include "model/formats/motion_file.h"
#include "model/motion/resample.h"

namespace duet::contrib::load {
namespace {

namespace cli = client::cli;
namespace fs = std::filesystem;

constexpr double kLiveRate = 30, kLowestLiveRate = 1, kHighestLiveRate = 240;  // frames a second
constexpr int kGeneratedFrames = 300;
constexpr char kGroup[] = "Options";                   // CLI11's name of the flags without a group
constexpr absl::Duration kEnding = absl::Seconds(30);  // of live sessions

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
  duet-load --live 20,50 --leader samples/hug.bvh --jitter 15 --loss 0.01
)";

struct LoadArguments {
  cli::ServerArguments server;
  CallContent content;
  std::vector<int> callers;   // a step each; and
  std::vector<double> rates;  // a step each; neither: one caller. Live: the frames' rate
  CallOptions calls;
  int connections = 1;
  double warm_up_seconds = 1, seconds = 10;
  bool bulk = false;
  std::vector<int> sessions;  // live sessions in place of calls; a step each
  LiveContent live_content;
  LiveOptions live;
  double jitter_ms = 0, stall_ms = 0;
  std::vector<fs::path> leaders;  // of live sessions; none: generated
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
  CLI::Option* seconds =
      app->add_option("--seconds", arguments->seconds, "Measured seconds of each step")
          ->check(CLI::Range(0.1, 864000.0))
          ->capture_default_str()
          ->type_name("SECONDS");
  app->add_option("--calls", arguments->calls.calls, "Number of measured calls, not --seconds")
      ->check(CLI::Range(int64_t{1}, int64_t{1000000000}))
      ->excludes(seconds)
      ->type_name("N");
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
  app->add_flag("--bulk", arguments->bulk, "Give the calls the priority of bulk calls");
  app->add_option("--json", arguments->json, "Write everything; - for standard output")
      ->type_name("FILE");
  app->add_flag("--quiet", arguments->quiet, "Do not print the current step");
}

void AddLive(CLI::App* app, LoadArguments* arguments) {
  CLI::Option* live =
      app->add_option(
             "--live", arguments->sessions,
             "Live sessions side by side; --rate is then their frames a second, default 30")
          ->delimiter(',')
          ->check(CLI::Range(1, 100000))
          ->type_name("N,...");
  for (const char* other : {"--callers", "--calls", "--frames", "--bulk"}) {
    live->excludes(app->get_option(other));
  }
  const auto milliseconds = [app, live](const char* name, double* time, const char* help) {
    app->add_option(name, *time, help)
        ->check(CLI::Range(0.0, 60000.0))
        ->needs(live)
        ->type_name("MS");
  };
  app->add_option("--leader", arguments->leaders,
                  "Motion file of a leader, which plays forwards and backwards; repeatable: "
                  "sessions take them in turn (default: a generated one)")
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
  app->add_option("--plan", arguments->live_content.plan_frames, "Provisional frames of messages")
      ->check(CLI::Range(0, 30))
      ->capture_default_str()
      ->needs(live)
      ->type_name("FRAMES");
  milliseconds("--jitter", &arguments->jitter_ms,
               "Send each frame up to this long after it was due");
  app->add_option("--loss", arguments->live.loss, "Share of the frames that are never sent")
      ->check(CLI::Range(0.0, 0.9))
      ->needs(live)
      ->type_name("SHARE");
  milliseconds("--stall", &arguments->stall_ms,
               "Once in each session: send nothing for this long, then everything held back");
  app->add_flag("--in-step", arguments->live.in_step,
                "Send the frames of all sessions at the same time")
      ->needs(live);
}

std::vector<std::pair<std::string, std::string>> GivenFlags(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* flag : app.get_options()) {
    if (flag->count() > 0) {
      given.emplace_back(flag->get_single_name(), absl::StrJoin(flag->results(), ","));
    }
  }
  return given;
}

// Runs the steps of a command line.
class LoadRun {
 public:
  // All of them outlive the run.
  LoadRun(LoadArguments* arguments, const LoadEnvironment& environment, Report* report)
      : arguments_(*arguments), environment_(environment), report_(*report) {
    arguments_.calls.stopped = arguments_.live.stopped = environment.stopped;
    arguments_.calls.warm_up = arguments_.live.warm_up = Seconds(arguments_.warm_up_seconds);
    arguments_.calls.measured = arguments_.live.measured = Seconds(arguments_.seconds);
    arguments_.live.jitter = Seconds(arguments_.jitter_ms / 1000);
    arguments_.live.stall = Seconds(arguments_.stall_ms / 1000);
    if (arguments_.bulk) arguments_.content.priority = client::Priority::kBulk;
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
    if (environment_.stopped()) return false;
    if (!arguments_.quiet) *environment_.err << "duet-load: " << step << std::endl;
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
        ConnectSessions(options, arguments_.connections, std::move(sessions));
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
    sessions->content = arguments_.live_content;
    sessions->content.model = arguments_.content.model;
    sessions->content.labels = arguments_.content.labels;
    const absl::StatusOr<client::ModelDetails> details = client.GetModel(sessions->content.model);
    if (!details.ok()) return details.status();
    sessions->model = details->model;
    report_.model = absl::StrCat(details->model.name, "@", details->model.version);
    sessions->frame_rate_hz = rate;
    sessions->longest = absl::Seconds(arguments_.warm_up_seconds + arguments_.seconds) + kEnding;
    return ReadLeaders(details->model, rate, &sessions->leaders);
  }

  // The leaders in the model's joints, at a rate.
  absl::Status ReadLeaders(const client::ModelInfo& model, double rate,
                           std::vector<motion::Poses>* leaders) {
    if (arguments_.leaders.empty())
      leaders->push_back(SwayingLeader(model, kGeneratedFrames).poses);
    const absl::StatusOr<motion::Skeleton> skeleton = client::ToSkeleton(model);
    if (!skeleton.ok()) return skeleton.status();
    formats::ReadOptions options;
    options.skeleton = *skeleton;
    for (const fs::path& file : arguments_.leaders) {
      const absl::StatusOr<motion::Clip> clip = formats::ReadLeader(file, options);
      if (!clip.ok()) return clip.status();
      leaders->push_back(motion::Resample(clip->poses, clip->frame_rate_hz, rate));
    }
    return absl::OkStatus();
  }

  LoadArguments& arguments_;
  const LoadEnvironment& environment_;
  Report& report_;
};

// JSON on standard output takes the place of the text.
absl::Status Write(const Report& report, const fs::path& json, std::ostream* out) {
  *out << (json == "-" ? ToJson(report) : ToText(report));
  if (absl::Status written = base::FlushOutput(out); !written.ok()) return written;
  return json.empty() || json == "-" ? absl::OkStatus() : base::WriteFile(json, ToJson(report));
}

}  // namespace

int RunLoadProgram(const std::vector<std::string>& arguments, const LoadEnvironment& environment) {
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
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {  // also --help and --version
    return app.exit(error, *environment.out, *environment.err) == 0 ? kDone : kBadUsage;
  }
  Report report;
  report.program = "duet-load " DUET_VERSION;
  report.settings = GivenFlags(app);
  absl::Status status = LoadRun(&parsed, environment, &report).Run();
  if (status.ok()) status = Write(report, parsed.json, environment.out);
  if (!status.ok()) {
    *environment.err << "duet-load: " << status.message() << " ("
                     << absl::StatusCodeToString(status.code()) << ")\n";
    return client::IsPermanent(status) ? kRejected : kNotAnswered;
  }
  if (IsAnswered(report)) return kDone;
  *environment.err << "duet-load: nothing was answered\n";
  return kNotAnswered;
}

}  // namespace duet::contrib::load
