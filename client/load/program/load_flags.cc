#include "client/load/program/load_flags.h"

#include <algorithm>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/flags.h"
#include "client/cli/server_flags.h"
#include "client/cli/value_syntax.h"
#include "model/base/text.h"

namespace duet::client::load::program {
namespace {

using cli::AddChoice;
using cli::AddParsed;
using cli::Undescribed;

constexpr char kLoadGroup[] = "Load", kLiveGroup[] = "Live sessions", kCallGroup[] = "Calls",
               kOutputGroup[] = "Output";

const std::map<std::string, ArrivalKind> kArrivals = {{"poisson", ArrivalKind::kPoisson},
                                                      {"constant", ArrivalKind::kConstant}};
const std::map<std::string, Priority> kPriorities = {{"interactive", Priority::kInteractive},
                                                     {"bulk", Priority::kBulk}};

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
      absl::StrCat("expected ", expected, ", such as 46=9,460, got ", base::Quoted(text)));
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
      return Expected("a weight above 0 after the =", part);
    }
    mix.push_back({*std::move(value), weight});
  }
  return mix;
}

absl::StatusOr<int> ParseFrameCount(absl::string_view text) {
  int frames = 0;
  if (base::ParseInteger(text, &frames) && frames >= 1) return frames;
  return Expected("numbers of frames, 1 or more", text);
}

void AddLoad(CLI::App* app, LoadArguments* arguments) {
  CLI::Option* callers =
      app->add_option("--callers", arguments->callers,
                      "Concurrent callers; each calls again after an answer (default: 1)")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(Undescribed(CLI::Range(1, 100000)))
          ->type_name("N[,N...]")
          ->group(kLoadGroup);
  app->add_option("--rate", arguments->rates, "Calls a second, independent of the answers")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(Undescribed(CLI::Range(0.001, 1e6)))
      ->excludes(callers)
      ->type_name("HZ[,HZ...]")
      ->group(kLoadGroup);
  AddChoice<ArrivalKind>(
      app, "--arrivals", kArrivals, [arguments](ArrivalKind kind) { arguments->arrivals = kind; },
      "Gaps between the calls of a rate: random or constant")
      ->default_str(cli::NameOf(kArrivals, arguments->arrivals))
      ->group(kLoadGroup);
  app->add_option("--warm-up", arguments->warm_up_seconds, "Unmeasured seconds before each step")
      ->check(Undescribed(CLI::Range(0.0, 86400.0)))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kLoadGroup);
  CLI::Option* seconds =
      app->add_option("--seconds", arguments->seconds, "Measured seconds of each step")
          ->check(Undescribed(CLI::Range(0.1, 864000.0)))
          ->capture_default_str()
          ->type_name("SECONDS")
          ->group(kLoadGroup);
  app->add_option("--calls", arguments->calls, "Number of measured calls, in place of --seconds")
      ->check(Undescribed(CLI::Range(int64_t{1}, int64_t{1000000000})))
      ->excludes(seconds)
      ->type_name("N")
      ->group(kLoadGroup);
  app->add_option("--connections", arguments->connections, "Connections, which calls use in turn")
      ->check(Undescribed(CLI::Range(1, 1000)))
      ->capture_default_str()
      ->type_name("N")
      ->group(kLoadGroup);
  app->add_option("--max-in-flight", arguments->max_in_flight,
                  "Maximum calls in flight with --rate; further calls are sent late, and reported")
      ->check(Undescribed(CLI::Range(1, 1000000)))
      ->capture_default_str()
      ->type_name("N")
      ->group(kLoadGroup);
  AddParsed<uint64_t>(
      app, "--seed", "SEED", cli::ParseSeed, [arguments](uint64_t seed) { arguments->seed = seed; },
      "Seed of arrivals and requests: the same seed gives the same load")
      ->take_last()
      ->default_str(absl::StrCat(arguments->seed))
      ->group(kLoadGroup);
}

// A flag in milliseconds.
CLI::Option* AddMilliseconds(CLI::App* app, const char* name, Duration* time, const char* text) {
  return app
      ->add_option_function<double>(
          name, [time](double milliseconds) { *time = Seconds(milliseconds / 1000); }, text)
      ->check(Undescribed(CLI::Range(0.0, 60000.0)))
      ->type_name("MS")
      ->group(kLiveGroup);
}

void AddLive(CLI::App* app, LoadArguments* arguments) {
  CLI::Option* live =
      app->add_option(
             "--live", arguments->live,
             "Live sessions side by side; --rate is then their frames a second, default 30")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(Undescribed(CLI::Range(1, 100000)))
          ->type_name("N[,N...]")
          ->group(kLiveGroup);
  for (const char* other :
       {"--callers", "--calls", "--arrivals", "--max-in-flight", "--background-callers", "--frames",
        "--priority", "--csv", "--records"}) {
    live->excludes(app->get_option(other));
  }
  app->add_option(
         "--leader", arguments->leaders,
         "Motion file of a leader, which plays forwards and backwards; repeatable: sessions "
         "take them in turn (default: a generated one)")
      ->check(Undescribed(CLI::ExistingFile))
      ->needs(live)
      ->allow_extra_args(false)
      ->type_name("FILE")
      ->group(kLiveGroup);
  app->add_option("--delay", arguments->live_content.delay_frames,
                  "Later leader frames that the server waits for")
      ->check(Undescribed(CLI::Range(0, 10)))
      ->capture_default_str()
      ->needs(live)
      ->type_name("FRAMES")
      ->group(kLiveGroup);
  app->add_option("--plan", arguments->live_content.plan_frames,
                  "Provisional frames in each message")
      ->check(Undescribed(CLI::Range(0, 30)))
      ->capture_default_str()
      ->needs(live)
      ->type_name("FRAMES")
      ->group(kLiveGroup);
  LiveConditions* conditions = &arguments->live_conditions;
  AddMilliseconds(app, "--jitter", &conditions->jitter,
                  "Send each frame up to this long after it was due")
      ->needs(live);
  app->add_option("--loss", conditions->loss, "Share of the frames that are never sent")
      ->check(Undescribed(CLI::Range(0.0, 0.9)))
      ->needs(live)
      ->type_name("SHARE")
      ->group(kLiveGroup);
  AddMilliseconds(app, "--stall", &conditions->stall,
                  "Once in each session: send nothing for this long, then everything held back")
      ->needs(live);
  app->add_flag("--in-step", arguments->in_step, "Send the frames of all sessions at the same time")
      ->needs(live)
      ->group(kLiveGroup);
}

void AddBackground(CLI::App* app, LoadArguments* arguments) {
  CLI::Option* callers = app->add_option("--background-callers", arguments->background_callers,
                                         "Callers that call continuously and are not measured")
                             ->check(Undescribed(CLI::Range(0, 100000)))
                             ->capture_default_str()
                             ->type_name("N")
                             ->group(kLoadGroup);
  app->add_option("--background-frames", arguments->background_frames, "Frames of their leaders")
      ->check(Undescribed(CLI::Range(1, 10000000)))
      ->capture_default_str()
      ->needs(callers)
      ->type_name("FRAMES")
      ->group(kLoadGroup);
  AddParsed<ModelChoice>(
      app, "--background-model", "NAME[@VERSION|:LABEL]", cli::ParseModelChoice,
      [arguments](ModelChoice model) { arguments->background_model = std::move(model); },
      "Their model (default: the first measured one)")
      ->take_last()
      ->needs(callers)
      ->group(kLoadGroup);
}

void AddCalls(CLI::App* app, LoadArguments* arguments) {
  AddParsed<std::vector<Weighted<int>>>(
      app, "--frames", "FRAMES[=WEIGHT],...", ParseFrames,
      [arguments](std::vector<Weighted<int>> frames) { arguments->mix.frames = std::move(frames); },
      "Lengths of the leaders, drawn by weight")
      ->take_last()
      ->default_str(absl::StrCat(arguments->mix.frames.front().value))
      ->group(kCallGroup);
  AddParsed<std::vector<Weighted<ModelChoice>>>(
      app, "--model", "MODEL[=WEIGHT],...", ParseModels,
      [arguments](std::vector<Weighted<ModelChoice>> models) {
        arguments->mix.models = std::move(models);
      },
      "NAME, NAME@VERSION or NAME:LABEL, drawn by weight (default: the server's)")
      ->take_last()
      ->group(kCallGroup);
  AddParsed<ClassWeight>(app, "--label", "CLASS[=WEIGHT]", cli::ParseClassWeight,
                         cli::AppendTo(&arguments->mix.labels),
                         "Repeatable (default: 1 for the model's first class)")
      ->group(kCallGroup);
  AddChoice<Priority>(
      app, "--priority", kPriorities,
      [arguments](Priority priority) { arguments->mix.priority = priority; },
      "Priority of the calls")
      ->default_str(cli::NameOf(kPriorities, arguments->mix.priority))
      ->group(kCallGroup);
  app->add_option("--deadline", arguments->server.timeout_seconds, "Deadline of each call")
      ->check(Undescribed(CLI::Range(0.001, 86400.0)))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kCallGroup);
}

void AddOutputs(CLI::App* app, LoadArguments* arguments) {
  app->add_option("--html", arguments->html, "Write a page with tables and charts")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app->add_option("--csv", arguments->csv, "Write a row for each step")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app->add_option("--json", arguments->json, "Write everything; - for standard output")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app->add_option("--records", arguments->records, "Write a CSV row for each call")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app->add_option("--title", arguments->title, "Title of the report")
      ->type_name("TEXT")
      ->group(kOutputGroup);
  app->add_flag("--quiet", arguments->quiet, "Do not print the current step")->group(kOutputGroup);
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
  app->get_formatter()->column_width(34);
  app->add_option("--server", arguments->server.address,
                  "Server, or any gRPC target such as unix:/run/duet.sock")
      ->envname("DUET_SERVER")
      ->capture_default_str()
      ->type_name("HOST:PORT")
      ->group(cli::kServerGroup);
  cli::AddCredentialFlags(app, &arguments->server);
  AddLoad(app, arguments);
  AddBackground(app, arguments);
  AddCalls(app, arguments);
  AddOutputs(app, arguments);
  AddLive(app, arguments);
  app->add_flag("--man", arguments->manual_page, "Print the manual page");
  app->add_option("--completion", arguments->completion, "Print the completion script of a shell")
      ->check(Undescribed(CLI::IsMember(std::vector<std::string>{"bash", "zsh", "fish"})))
      ->type_name("bash|zsh|fish");
}

std::vector<std::pair<std::string, std::string>> GivenFlags(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    given.emplace_back(option->get_lnames().front(), absl::StrJoin(option->results(), ","));
  }
  return given;
}

absl::StatusOr<std::vector<Weighted<int>>> ParseFrames(absl::string_view text) {
  return ParseMix<int>(text, ParseFrameCount);
}

absl::StatusOr<std::vector<Weighted<ModelChoice>>> ParseModels(absl::string_view text) {
  return ParseMix<ModelChoice>(text, cli::ParseModelChoice);
}

}  // namespace duet::client::load::program
