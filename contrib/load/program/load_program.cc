#include "contrib/load/program/load_program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <ostream>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/client.h"
#include "client/error_details.h"
#include "contrib/load/call_kinds.h"
#include "contrib/load/generator.h"
#include "contrib/load/grpc_target.h"
#include "contrib/load/program/live_run.h"
#include "contrib/load/program/load_flags.h"
#include "contrib/load/program/report_files.h"
#include "contrib/load/report.h"
#include "model/base/file.h"

namespace duet::contrib::load::program {
namespace {

constexpr double kMostIntervals = 300;  // of a timeline: as many as a chart can show

// Uses the client's retries; measured calls have one attempt.
absl::StatusOr<std::vector<CallKind>> FindAllKinds(const LoadArguments& arguments,
                                                   const client::ClientOptions& options) {
  const absl::StatusOr<client::Client> client = client::Client::Create(options);
  if (!client.ok()) return client.status();
  absl::StatusOr<std::vector<CallKind>> kinds = FindKinds(*client, arguments.mix);
  if (!kinds.ok() || arguments.background_callers == 0) return kinds;
  CallMix background = arguments.mix;
  background.models = {{arguments.background_model.value_or(arguments.mix.models[0].value), 1}};
  background.frames = {{arguments.background_frames, 1}};
  const absl::StatusOr<std::vector<CallKind>> unmeasured = FindKinds(*client, background);
  if (!unmeasured.ok()) return unmeasured.status();
  kinds->push_back(unmeasured->front());
  return kinds;
}

class LoadRun {
 public:
  LoadRun(const LoadArguments& arguments, const LoadEnvironment& environment)
      : arguments_(arguments), environment_(environment) {}

  absl::Status Run(std::vector<std::pair<std::string, std::string>> settings) {
    absl::Status status = Prepare();
    if (!status.ok()) return status;
    static_cast<ReportHead&>(report_) = MakeHead(arguments_, "Load", std::move(settings));
    for (const Step& step : arguments_.Steps()) {
      if (environment_.stopped()) break;
      if (!arguments_.quiet) *environment_.err << "duet-load: " << StepName(step) << std::endl;
      report_.steps.push_back(RunOne(step));
    }
    return WriteReports();
  }

  bool HasAnswers() const {
    const auto answered = [](const Measurement& step) { return step.answered() > 0; };
    return std::any_of(report_.steps.begin(), report_.steps.end(), answered);
  }

 private:
  absl::Status Prepare() {
    const absl::StatusOr<client::ClientOptions> options = ToClientOptions(arguments_.server);
    if (!options.ok()) return options.status();
    absl::StatusOr<std::vector<CallKind>> kinds = FindAllKinds(arguments_, *options);
    if (!kinds.ok()) return kinds.status();
    std::vector<std::string> requests;
    for (const CallKind& kind : *kinds) requests.push_back(kind.request);
    absl::StatusOr<std::unique_ptr<Target>> target =
        ConnectTarget(*options, arguments_.connections, requests);
    if (!target.ok()) return target.status();
    target_ = *std::move(target);
    if (arguments_.background_callers > 0) kinds->pop_back();
    Describe(*kinds);
    return OpenRecords();
  }

  void Describe(const std::vector<CallKind>& kinds) {
    double sum = 0;
    for (const CallKind& kind : kinds) sum += kind.weight;
    weights_.clear();
    for (const CallKind& kind : kinds) {
      weights_.push_back(kind.weight);
      report_.kinds.push_back({kind.model, kind.frames, kind.weight / sum});
    }
  }

  absl::Status OpenRecords() {
    if (arguments_.records.empty()) return absl::OkStatus();
    // Its status describes what is wrong with the path.
    absl::Status status = base::WriteFile(arguments_.records, RecordHeader());
    if (status.ok()) records_.open(arguments_.records, std::ios::app);
    return status;
  }

  Measurement RunOne(const Step& step) {
    LoadOptions options;
    options.kind_weights = weights_;
    options.arrivals = arguments_.arrivals;
    options.seed = arguments_.seed;
    options.warm_up = Seconds(arguments_.warm_up_seconds);
    options.measured = Seconds(arguments_.seconds);
    options.calls = arguments_.calls;
    options.max_in_flight = arguments_.max_in_flight;
    options.background_callers = arguments_.background_callers;
    options.background_kind = weights_.size();
    options.interval = Seconds(std::max(1.0, arguments_.seconds / kMostIntervals));
    options.stopped = environment_.stopped;
    if (records_.is_open()) {
      options.on_record = [this, step](const CallRecord& record) {
        records_ << RecordLine(step, report_.kinds[record.kind], record);
      };
    }
    const double now = absl::ToDoubleSeconds(absl::Now() - absl::UnixEpoch());
    Measurement measurement = RunStep(step, options, *target_);
    measurement.began_unix = now + arguments_.warm_up_seconds;
    return measurement;
  }

  absl::Status WriteReports() {
    absl::Status status = WriteReport(ToText(report_),
                                      {{arguments_.json, [this] { return ToJson(report_); }},
                                       {arguments_.csv, [this] { return ToCsv(report_); }},
                                       {arguments_.html, [this] { return ToPage(report_); }}},
                                      environment_.out);
    if (!status.ok()) return status;
    records_.flush();
    if (records_.is_open() && !records_) {
      return absl::InvalidArgumentError(
          absl::StrCat(arguments_.records.string(), ": could not write every record"));
    }
    return absl::OkStatus();
  }

  const LoadArguments& arguments_;
  const LoadEnvironment& environment_;
  std::unique_ptr<Target> target_;
  std::vector<double> weights_;
  std::ofstream records_;
  Report report_;
};

// Runs live sessions and writes their report. Sets `answered` if any was.
absl::Status RunLiveLoad(const LoadArguments& arguments, const LoadEnvironment& environment,
                         std::vector<std::pair<std::string, std::string>> settings,
                         bool* answered) {
  const ReportHead head = MakeHead(arguments, "Live sessions", std::move(settings));
  absl::StatusOr<LiveReport> report = RunLiveSteps(arguments, environment);
  if (!report.ok()) return report.status();
  static_cast<ReportHead&>(*report) = head;
  for (const LiveMeasurement& step : report->steps) *answered = *answered || step.answered > 0;
  return WriteReport(ToText(*report),
                     {{arguments.json, [&] { return ToJson(*report); }},
                      {arguments.html, [&] { return ToPage(*report); }}},
                     environment.out);
}

// Runs calls and writes their report. Sets `answered` if any was.
absl::Status RunCallLoad(const LoadArguments& arguments, const LoadEnvironment& environment,
                         std::vector<std::pair<std::string, std::string>> settings,
                         bool* answered) {
  LoadRun run(arguments, environment);
  absl::Status status = run.Run(std::move(settings));
  *answered = run.HasAnswers();
  return status;
}

}  // namespace

int RunLoadProgram(const std::vector<std::string>& arguments, const LoadEnvironment& environment) {
  CLI::App app("Puts a load on a Duet server and measures its answers.", "duet-load");
  app.set_version_flag("--version", "duet-load " DUET_VERSION);
  LoadArguments parsed;
  AddLoadFlags(&app, &parsed);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {  // also --help and --version
    return app.exit(error, *environment.out, *environment.err) == 0 ? kDone : kBadUsage;
  }
  bool answered = false;
  const absl::Status status = (parsed.live.empty() ? RunCallLoad : RunLiveLoad)(
      parsed, environment, GivenFlags(app), &answered);
  if (!status.ok()) {
    *environment.err << "duet-load: " << status.message() << " ("
                     << absl::StatusCodeToString(status.code()) << ")\n";
    return client::IsPermanent(status) ? kRejected : kNotAnswered;
  }
  if (answered) return kDone;
  *environment.err << "duet-load: no " << (parsed.live.empty() ? "call" : "session")
                   << " was answered\n";
  return kNotAnswered;
}

}  // namespace duet::contrib::load::program
