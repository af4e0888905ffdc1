#include "client/cli/synthesize_command.h"

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/output.h"
#include "client/cli/report.h"
#include "client/cli/request_building.h"
#include "client/cli/server_options.h"
#include "client/model_skeleton.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using Paths = std::vector<std::filesystem::path>;

// ABORTED instead of PERMISSION_DENIED: a disk may be full or a folder closed for a while, so the
// same call may succeed later.
absl::Status NotWritten(const absl::Status& status) {
  const auto code = absl::IsPermissionDenied(status) ? absl::StatusCode::kAborted : status.code();
  return absl::Status(code, absl::StrCat("cannot write the result: ", status.message()));
}

absl::StatusOr<Paths> WriteAll(const Paths& outputs, const Synthesis& synthesis) {
  Paths written;
  for (const std::filesystem::path& output : outputs) {
    absl::StatusOr<Paths> files = WriteOutput(output, synthesis);
    if (!files.ok()) return NotWritten(files.status());
    written.insert(written.end(), files->begin(), files->end());
  }
  return written;
}

// What every sample has in common.
struct Job {
  SynthesisRequest request;
  motion::Skeleton skeleton;
  bool sampled = false;
  std::vector<std::string> notes;  // on how the leader was read
};

absl::StatusOr<Job> PrepareJob(const SynthesizeArguments& arguments, const Client& client) {
  const absl::StatusOr<ModelDetails> details = client.GetModel(arguments.model);
  if (!details.ok()) return details.status();
  absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  Job job;
  absl::StatusOr<SynthesisRequest> request = BuildRequest(arguments, *skeleton, &job.notes);
  if (!request.ok()) return request.status();
  job.request = *std::move(request);
  job.skeleton = *std::move(skeleton);
  job.sampled = details->model.samples;
  return job;
}

// Asks for every sample in turn, and writes and reports each before the next.
absl::Status RunSamples(const SynthesizeArguments& arguments, const Job& job, const Client& client,
                        std::ostream& out) {
  std::vector<nlohmann::json> samples;
  for (int sample = 0; sample < arguments.samples; ++sample) {
    SynthesisRequest request = job.request;
    request.seed = SeedOf(arguments, sample);
    absl::StatusOr<SynthesisResult> result = client.Synthesize(request);
    if (!result.ok()) return result.status();
    const Synthesis synthesis{std::move(request), *std::move(result), job.skeleton,
                              arguments.leader, job.sampled};
    const absl::StatusOr<Paths> written = WriteAll(SampleOutputs(arguments, sample), synthesis);
    if (!written.ok()) return written.status();
    if (arguments.quiet) continue;
    if (arguments.json) {
      samples.push_back(SynthesisJson(synthesis, *written, job.notes));
    } else {
      out << (sample == 0 ? DescribeRequest(synthesis, job.notes) : "")
          << DescribeAnswer(synthesis, *written);
    }
  }
  if (!samples.empty()) out << SamplesJson(samples);
  return absl::OkStatus();
}

}  // namespace

absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment) {
  absl::Status inputs = CheckInputs(arguments);
  if (!inputs.ok()) return inputs;
  const absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  const absl::StatusOr<Client> client = environment.connect(*options);
  if (!client.ok()) return client.status();
  const absl::StatusOr<Job> job = PrepareJob(arguments, *client);
  if (!job.ok()) return job.status();
  return RunSamples(arguments, *job, *client, *environment.out);
}

}  // namespace duet::client::cli
