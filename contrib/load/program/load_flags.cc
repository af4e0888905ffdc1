#include "contrib/load/program/load_flags.h"

#include <algorithm>
#include <map>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/flags.h"
#include "client/cli/server_flags.h"
#include "client/cli/value_syntax.h"
#include "model/base/text.h"

namespace duet::contrib::load::program {
namespace {

using client::cli::AddChoice;
using client::cli::AddParsed;
using client::cli::Flag;
using client::cli::FlagSet;

constexpr char kLoadGroup[] = "Load", kLiveGroup[] = "Live sessions", kCallGroup[] = "Calls",
               kOutputGroup[] = "Output";

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

void AddLoad(FlagSet* app, LoadArguments* arguments) {
  Flag* callers = app->Add("--callers", &arguments->callers,
                           "Concurrent callers; each calls again after an answer (default: 1)")
                      ->SplitAt(',')
                      ->OneValueEach()
                      ->InRange(1, 100000)
                      ->Form("N[,N...]")
                      ->Group(kLoadGroup);
  app->Add("--rate", &arguments->rates, "Calls a second, independent of the answers")
      ->SplitAt(',')
      ->OneValueEach()
      ->InRange(0.001, 1e6)
      ->Excludes(callers)
      ->Form("HZ[,HZ...]")
      ->Group(kLoadGroup);
  AddChoice<ArrivalKind>(
      app, "--arrivals", kArrivals, [arguments](ArrivalKind kind) { arguments->arrivals = kind; },
      "Gaps between the calls of a rate: random or constant")
      ->ShowDefault(client::cli::NameOf(kArrivals, arguments->arrivals))
      ->Group(kLoadGroup);
  app->Add("--warm-up", &arguments->warm_up_seconds, "Unmeasured seconds before each step")
      ->InRange(0.0, 86400.0)
      ->ShowDefault()
      ->Form("SECONDS")
      ->Group(kLoadGroup);
  Flag* seconds = app->Add("--seconds", &arguments->seconds, "Measured seconds of each step")
                      ->InRange(0.1, 864000.0)
                      ->ShowDefault()
                      ->Form("SECONDS")
                      ->Group(kLoadGroup);
  app->Add("--calls", &arguments->calls, "Number of measured calls, in place of --seconds")
      ->InRange(int64_t{1}, int64_t{1000000000})
      ->Excludes(seconds)
      ->Form("N")
      ->Group(kLoadGroup);
  app->Add("--connections", &arguments->connections, "Connections, which calls use in turn")
      ->InRange(1, 1000)
      ->ShowDefault()
      ->Form("N")
      ->Group(kLoadGroup);
  app->Add("--max-in-flight", &arguments->max_in_flight,
           "Maximum calls in flight with --rate; further calls are sent late, and reported")
      ->InRange(1, 1000000)
      ->ShowDefault()
      ->Form("N")
      ->Group(kLoadGroup);
  AddParsed<uint64_t>(
      app, "--seed", "SEED", client::cli::ParseSeed,
      [arguments](uint64_t seed) { arguments->seed = seed; },
      "Seed of arrivals and requests: the same seed gives the same load")
      ->LastOnly()
      ->ShowDefault(absl::StrCat(arguments->seed))
      ->Group(kLoadGroup);
}

// A flag in milliseconds.
Flag* AddMilliseconds(FlagSet* app, const char* name, Duration* time, const char* help) {
  return app
      ->AddReader(
          name,
          [time](const std::string& text) {
            double milliseconds = 0;
            base::ParseNumber(text, &milliseconds);
            *time = Seconds(milliseconds / 1000);
          },
          help)
      ->InRange(0.0, 60000.0)
      ->Form("MS")
      ->Group(kLiveGroup);
}

void AddLive(FlagSet* app, LoadArguments* arguments) {
  Flag* live =
      app->Add("--live", &arguments->live,
               "Live sessions side by side; --rate is then their frames a second, default 30")
          ->SplitAt(',')
          ->OneValueEach()
          ->InRange(1, 100000)
          ->Form("N[,N...]")
          ->Group(kLiveGroup);
  for (const char* other :
       {"--callers", "--calls", "--arrivals", "--max-in-flight", "--background-callers", "--frames",
        "--priority", "--csv", "--records"}) {
    live->Excludes(app->Find(other));
  }
  app->Add("--leader", &arguments->leaders,
           "Motion file of a leader, which plays forwards and backwards; repeatable: sessions "
           "take them in turn (default: a generated one)")
      ->ExistingFile()
      ->Needs(live)
      ->OneValueEach()
      ->Form("FILE")
      ->Group(kLiveGroup);
  app->Add("--delay", &arguments->live_content.delay_frames,
           "Later leader frames that the server waits for")
      ->InRange(0, 10)
      ->ShowDefault()
      ->Needs(live)
      ->Form("FRAMES")
      ->Group(kLiveGroup);
  app->Add("--plan", &arguments->live_content.plan_frames, "Provisional frames in each message")
      ->InRange(0, 30)
      ->ShowDefault()
      ->Needs(live)
      ->Form("FRAMES")
      ->Group(kLiveGroup);
  LiveConditions* conditions = &arguments->live_conditions;
  AddMilliseconds(app, "--jitter", &conditions->jitter,
                  "Send each frame up to this long after it was due")
      ->Needs(live);
  app->Add("--loss", &conditions->loss, "Share of the frames that are never sent")
      ->InRange(0.0, 0.9)
      ->Needs(live)
      ->Form("SHARE")
      ->Group(kLiveGroup);
  AddMilliseconds(app, "--stall", &conditions->stall,
                  "Once in each session: send nothing for this long, then everything held back")
      ->Needs(live);
  app->AddSwitch("--in-step", &arguments->in_step,
                 "Send the frames of all sessions at the same time")
      ->Needs(live)
      ->Group(kLiveGroup);
}

void AddBackground(FlagSet* app, LoadArguments* arguments) {
  Flag* callers = app->Add("--background-callers", &arguments->background_callers,
                           "Callers that call continuously and are not measured")
                      ->InRange(0, 100000)
                      ->ShowDefault()
                      ->Form("N")
                      ->Group(kLoadGroup);
  app->Add("--background-frames", &arguments->background_frames, "Frames of their leaders")
      ->InRange(1, 10000000)
      ->ShowDefault()
      ->Needs(callers)
      ->Form("FRAMES")
      ->Group(kLoadGroup);
  AddParsed<client::ModelChoice>(
      app, "--background-model", "NAME[@VERSION|:LABEL]", client::cli::ParseModelChoice,
      [arguments](client::ModelChoice model) { arguments->background_model = std::move(model); },
      "Their model (default: the first measured one)")
      ->LastOnly()
      ->Needs(callers)
      ->Group(kLoadGroup);
}

void AddCalls(FlagSet* app, LoadArguments* arguments) {
  AddParsed<std::vector<Weighted<int>>>(
      app, "--frames", "FRAMES[=WEIGHT],...", ParseFrames,
      [arguments](std::vector<Weighted<int>> frames) { arguments->mix.frames = std::move(frames); },
      "Lengths of the leaders, drawn by weight")
      ->LastOnly()
      ->ShowDefault(absl::StrCat(arguments->mix.frames.front().value))
      ->Group(kCallGroup);
  AddParsed<std::vector<Weighted<client::ModelChoice>>>(
      app, "--model", "MODEL[=WEIGHT],...", ParseModels,
      [arguments](std::vector<Weighted<client::ModelChoice>> models) {
        arguments->mix.models = std::move(models);
      },
      "NAME, NAME@VERSION or NAME:LABEL, drawn by weight (default: the server's)")
      ->LastOnly()
      ->Group(kCallGroup);
  AddParsed<client::ClassWeight>(app, "--label", "CLASS[=WEIGHT]", client::cli::ParseClassWeight,
                                 client::cli::AppendTo(&arguments->mix.labels),
                                 "Repeatable (default: 1 for the model's first class)")
      ->Group(kCallGroup);
  AddChoice<client::Priority>(
      app, "--priority", kPriorities,
      [arguments](client::Priority priority) { arguments->mix.priority = priority; },
      "Priority of the calls")
      ->ShowDefault(client::cli::NameOf(kPriorities, arguments->mix.priority))
      ->Group(kCallGroup);
  app->Add("--deadline", &arguments->server.timeout_seconds, "Deadline of each call")
      ->InRange(0.001, 86400.0)
      ->ShowDefault()
      ->Form("SECONDS")
      ->Group(kCallGroup);
}

void AddOutputs(FlagSet* app, LoadArguments* arguments) {
  app->Add("--html", &arguments->html, "Write a page with tables and charts")
      ->Form("FILE")
      ->Group(kOutputGroup);
  app->Add("--csv", &arguments->csv, "Write a row for each step")
      ->Form("FILE")
      ->Group(kOutputGroup);
  app->Add("--json", &arguments->json, "Write everything; - for standard output")
      ->Form("FILE")
      ->Group(kOutputGroup);
  app->Add("--records", &arguments->records, "Write a CSV row for each call")
      ->Form("FILE")
      ->Group(kOutputGroup);
  app->Add("--title", &arguments->title, "Title of the report")->Form("TEXT")->Group(kOutputGroup);
  app->AddSwitch("--quiet", &arguments->quiet, "Do not print the current step")
      ->Group(kOutputGroup);
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

void AddLoadFlags(FlagSet* app, LoadArguments* arguments) {
  app->Footer(kFooter);
  app->Add("--server", &arguments->server.address,
           "Server, or any gRPC target such as unix:/run/duet.sock")
      ->Environment("DUET_SERVER")
      ->ShowDefault()
      ->Form("HOST:PORT")
      ->Group(client::cli::kServerGroup);
  client::cli::AddCredentialFlags(app, &arguments->server);
  AddLoad(app, arguments);
  AddBackground(app, arguments);
  AddCalls(app, arguments);
  AddOutputs(app, arguments);
  AddLive(app, arguments);
  app->AddSwitch("--man", &arguments->manual_page, "Print the manual page");
  app->Add("--completion", &arguments->completion, "Print the completion script of a shell")
      ->OneOf({"bash", "zsh", "fish"})
      ->Form("bash|zsh|fish");
}

std::vector<std::pair<std::string, std::string>> GivenFlags(const FlagSet& app) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const std::unique_ptr<Flag>& flag : app.flags()) {
    if (!flag->is_given() || flag->is_argument()) continue;
    given.emplace_back(flag->name().substr(2), absl::StrJoin(flag->values(), ","));
  }
  return given;
}

absl::StatusOr<std::vector<Weighted<int>>> ParseFrames(absl::string_view text) {
  return ParseMix<int>(text, ParseFrameCount);
}

absl::StatusOr<std::vector<Weighted<client::ModelChoice>>> ParseModels(absl::string_view text) {
  return ParseMix<client::ModelChoice>(text, client::cli::ParseModelChoice);
}

}  // namespace duet::contrib::load::program
