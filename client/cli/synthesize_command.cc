#include "client/cli/synthesize_command.h"

#include <iterator>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/beat_report.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"
#include "client/cli/report.h"
#include "client/cli/request_building.h"
#include "client/cli/server_options.h"
#include "client/cli/synthesize_flags.h"
#include "client/model_skeleton.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using Paths = std::vector<std::filesystem::path>;

absl::Status WriteToStandardOutput(const OutputFormat& format, const Synthesis& synthesis,
                                   std::ostream& out) {
  const absl::StatusOr<std::string> content = FormatOutput(format, synthesis);
  return content.ok() ? WriteToStream(*content, out) : content.status();
}

absl::StatusOr<WrittenFiles> WriteAll(const SynthesizeArguments& arguments, const Paths& outputs,
                                      const Synthesis& synthesis, std::ostream& out) {
  WrittenFiles written;
  for (const std::filesystem::path& output : outputs) {
    if (output == kStandardStream) {
      absl::Status status = WriteToStandardOutput(*arguments.output_format, synthesis, out);
      if (!status.ok()) return status;
      written.files.push_back(output);
      continue;
    }
    absl::StatusOr<WrittenFiles> one = WriteOutput(output, synthesis);
    if (!one.ok()) return NotWritten(one.status());
    std::move(one->files.begin(), one->files.end(), std::back_inserter(written.files));
    std::move(one->notes.begin(), one->notes.end(), std::back_inserter(written.notes));
  }
  return written;
}

// The state that all samples share.
struct Job {
  SynthesisRequest request;
  motion::Skeleton skeleton;
  bool sampled = false;
  std::optional<formats::FollowerRig> follower_rig;
  std::vector<std::string> notes;  // about how the leader was read
};

absl::StatusOr<Job> PrepareJob(const SynthesizeArguments& arguments, const Client& client,
                               std::istream* in) {
  const absl::StatusOr<ModelDetails> details = client.GetModel(arguments.model);
  if (!details.ok()) return details.status();
  const absl::Status labels = CheckLabels(arguments, details->model);
  if (!labels.ok()) return labels;
  absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  Job job;
  absl::StatusOr<SynthesisRequest> request = BuildRequest(arguments, *skeleton, &job.notes, in);
  if (!request.ok()) return request.status();
  job.request = *std::move(request);
  job.skeleton = *std::move(skeleton);
  job.sampled = details->model.samples;
  if (!arguments.follower_rig.empty()) {
    absl::StatusOr<formats::FollowerRig> rig =
        BuildFollowerRig(arguments, job.skeleton, &job.notes);
    if (!rig.ok()) return rig.status();
    job.follower_rig = *std::move(rig);
  }
  return job;
}

// Requests the samples one after the other; writes and reports each before the next.
absl::Status RunSamples(const SynthesizeArguments& arguments, const Job& job, const Client& client,
                        const ProgramEnvironment& environment) {
  // With a motion on standard output, the report goes to standard error.
  std::ostream& out =
      WritesToStandardOutput(arguments.outputs) ? *environment.err : *environment.out;
  std::vector<nlohmann::json> samples;
  for (int sample = 0; sample < arguments.samples; ++sample) {
    SynthesisRequest request = job.request;
    request.seed = SeedOf(arguments, sample);
    absl::StatusOr<SynthesisResult> result = client.Synthesize(request);
    if (!result.ok()) return result.status();
    Synthesis synthesis;
    synthesis.request = std::move(request);
    synthesis.result = *std::move(result);
    synthesis.skeleton = job.skeleton;
    synthesis.leader_file = arguments.leader;
    synthesis.sampled = job.sampled;
    synthesis.bvh = arguments.bvh;
    synthesis.follower_rig = job.follower_rig;
    synthesis.beat = arguments.beat;
    const absl::StatusOr<WrittenFiles> written =
        WriteAll(arguments, SampleOutputs(arguments, sample), synthesis, *environment.out);
    if (!written.ok()) return written.status();
    if (arguments.quiet) continue;
    if (arguments.json) {
      samples.push_back(SynthesisJson(synthesis, *written, job.notes));
      if (arguments.beat) samples.back()["beat"] = BeatJson(synthesis);
    } else {
      out << (sample == 0 ? DescribeRequest(synthesis, job.notes) : "")
          << DescribeAnswer(synthesis, *written) << (arguments.beat ? DescribeBeat(synthesis) : "");
    }
  }
  if (!samples.empty()) out << SamplesJson(samples);
  return absl::OkStatus();
}

absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment) {
  absl::Status inputs = CheckInputs(arguments);
  if (!inputs.ok()) return inputs;
  const absl::StatusOr<Client> client = Connect(arguments.server, environment);
  if (!client.ok()) return client.status();
  const absl::StatusOr<Job> job = PrepareJob(arguments, *client, environment.in);
  if (!job.ok()) return job.status();
  return RunSamples(arguments, *job, *client, environment);
}

}  // namespace

Command AddSynthesizeCommand(FlagSet* program) {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  FlagSet* app = program->AddCommand("synthesize", "Synthesise the follower of a leader");
  AddSynthesizeFlags(app, arguments.get());
  app->Footer(kExitCodesFooter);
  return MakeServerCommand(app, arguments, RunSynthesize);
}

}  // namespace duet::client::cli
