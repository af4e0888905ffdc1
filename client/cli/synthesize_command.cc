#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/batch/text_values.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/output.h"
#include "client/cli/reaction.h"
#include "client/cli/report.h"
#include "client/cli/server.h"
#include "client/cli/summary.h"
#include "client/model_skeleton.h"
#include "model/base/program_flags.h"
#include "model/formats/motion_file.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using Paths = std::vector<std::filesystem::path>;

struct SynthesizeArguments : ReactionArguments {
  ServerArguments server;
  int samples = 1;  // answers, with the seeds `seed`, `seed` + 1, ...
  Paths outputs;
  std::optional<OutputFormat> output_format;  // for standard output
  bool json = false;
  bool quiet = false;
};

// "a.bvh --out b.json"
std::string OutputsText(const Paths& outputs) {
  return absl::StrJoin(outputs, " --out ", [](std::string* out, const std::filesystem::path& path) {
    out->append(path.string());
  });
}

// Whether an output holds joint rotations.
bool HoldsRotations(const SynthesizeArguments& arguments) {
  for (const std::filesystem::path& output : arguments.outputs) {
    const std::optional<formats::Format> format =
        output != kStandardStream ? formats::FormatOf(output) : arguments.output_format->motion;
    if (format == formats::Format::kJson) return true;
  }
  return false;
}

// Checks flags that depend on each other.
void CheckTogether(const SynthesizeArguments& arguments) {
  if (arguments.leader.empty() && arguments.request.empty()) RejectMissing("--leader or --request");
  if (arguments.weights.empty() && arguments.keyframes.empty() && arguments.request.empty()) {
    RejectMissing("--label, --keyframe or --request");
  }
  CheckStandardOutput(arguments.outputs, arguments.output_format, arguments.json);
  if (arguments.samples > 1 && WritesToStandardOutput(arguments.outputs)) {
    RejectFlag("--samples", "cannot be used with --out -: each answer needs a file");
  }
  if (arguments.output_format && arguments.output_format->motion == formats::Format::kBvh) {
    RejectFlag("--output-format",
               "bvh cannot be used with --out -: it has one file for each person");
  }
  for (const std::filesystem::path& output : arguments.outputs) {
    const absl::Status status = CheckOutput(output, {});
    if (!status.ok()) RejectFlag("--out", std::string(status.message()));
  }
}

// The output files of the answer with a seed. With several samples, pair.html becomes
// pair.seed7.html.
Paths OutputsOf(const SynthesizeArguments& arguments, uint64_t seed) {
  Paths outputs = arguments.outputs;
  if (arguments.samples == 1) return outputs;
  for (std::filesystem::path& output : outputs) {
    output.replace_filename(
        absl::StrCat(output.stem().string(), ".seed", seed, output.extension().string()));
  }
  return outputs;
}

// Checks what the flags and the request's file decide together, before the first call.
absl::Status CheckRequest(const SynthesizeArguments& arguments, const SynthesisRequest& request) {
  const uint64_t first = request.seed.value_or(0);
  const uint64_t left = std::numeric_limits<uint64_t>::max() - first;
  if (static_cast<uint64_t>(arguments.samples) - 1 > left) {
    return absl::InvalidArgumentError(
        absl::StrCat("--samples: expected at most ", left + 1, " with seed ", first,
                     ", so that no seed exceeds the largest, got ", arguments.samples));
  }
  if (request.rotations && !HoldsRotations(arguments)) {
    return absl::InvalidArgumentError(
        absl::StrCat("reply_rotations: expected --out FILE.json, which holds them, got --out ",
                     OutputsText(arguments.outputs)));
  }
  const Paths inputs = {arguments.leader, arguments.follower_start, arguments.request};
  for (int sample = 0; sample < arguments.samples; ++sample) {
    const uint64_t seed = first + static_cast<uint64_t>(sample);
    for (const std::filesystem::path& output : OutputsOf(arguments, seed)) {
      for (const std::filesystem::path& file : PairFiles(output)) {
        absl::Status status = CheckReplacesNone(file, inputs);
        if (!status.ok()) return status;
      }
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<WrittenFiles> WriteAll(const SynthesizeArguments& arguments, const Paths& outputs,
                                      const Synthesis& synthesis, std::ostream& out) {
  WrittenFiles written;
  for (const std::filesystem::path& output : outputs) {
    if (output == kStandardStream) {
      const absl::StatusOr<std::string> content = FormatOutput(*arguments.output_format, synthesis);
      if (!content.ok()) return content.status();
      absl::Status status = WriteToStream(*content, out);
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
  std::vector<std::string> notes;  // about how the leader was read
};

absl::StatusOr<Job> PrepareJob(const SynthesizeArguments& arguments, SynthesisRequest request,
                               const Client& client, std::istream* in) {
  const absl::StatusOr<ModelDetails> details = client.GetModel(request.model);
  if (!details.ok()) return details.status();
  const absl::Status labels = CheckLabels(request, details->model);
  if (!labels.ok()) return labels;
  absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  Job job{std::move(request), *std::move(skeleton), details->model.samples, {}};
  const absl::Status read = ReadMotions(arguments, job.skeleton, in, &job.request, &job.notes);
  if (!read.ok()) return read;
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
    Synthesis synthesis;
    synthesis.request = job.request;
    if (arguments.samples > 1) {
      synthesis.request.seed = job.request.seed.value_or(0) + static_cast<uint64_t>(sample);
    }
    absl::StatusOr<SynthesisResult> result = client.Synthesize(synthesis.request);
    if (!result.ok()) return result.status();
    synthesis.result = *std::move(result);
    synthesis.skeleton = job.skeleton;
    synthesis.leader_file = arguments.leader.empty() ? arguments.request : arguments.leader;
    synthesis.sampled = job.sampled;
    const absl::StatusOr<WrittenFiles> written =
        WriteAll(arguments, OutputsOf(arguments, synthesis.request.seed.value_or(0)), synthesis,
                 *environment.out);
    if (!written.ok()) return written.status();
    if (arguments.quiet) continue;
    if (arguments.json) {
      samples.push_back(SynthesisJson(synthesis, *written, job.notes));
    } else {
      out << (sample == 0 ? DescribeRequest(synthesis, job.notes) : "")
          << DescribeAnswer(synthesis, *written);
    }
  }
  if (samples.size() == 1) out << Print(samples.front());
  if (samples.size() > 1) out << Print({{"samples", samples}});
  return absl::OkStatus();
}

absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment) {
  const absl::Status inputs = CheckInputs(arguments);
  if (!inputs.ok()) return inputs;
  absl::StatusOr<SynthesisRequest> request = StartRequest(arguments);
  if (!request.ok()) return request.status();
  const absl::Status status = CheckRequest(arguments, *request);
  if (!status.ok()) return status;
  const absl::StatusOr<Client> client = Connect(arguments.server, environment);
  if (!client.ok()) return client.status();
  const absl::StatusOr<Job> job =
      PrepareJob(arguments, *std::move(request), *client, environment.in);
  if (!job.ok()) return job.status();
  return RunSamples(arguments, *job, *client, environment);
}

void AddFlags(CLI::App* app, SynthesizeArguments* arguments) {
  app->add_option("--leader", arguments->leader,
                  absl::StrCat("Motion of the leader: ", formats::kReadableExtensions,
                               "; - for standard input"))
      ->type_name("FILE")
      ->group(kInputGroup);
  AddLeaderFlags(app, arguments);
  AddReactionFlags(app, arguments);
  AddParsedList(app, "--pin", "JOINT@FRAME=X,Y,Z[,SOFTNESS]", batch::ParsePin, &arguments->pins,
                "Where a joint of the model must be in a frame, in metres, y up, such as "
                "right_hand@40=0.2,1.3,0.5; a softness up to 1 lets that share of the distance "
                "remain; repeatable")
      ->group(kReactionGroup);
  app->add_option("--samples", arguments->samples,
                  "Number of answers, with the seeds SEED, SEED+1, ... (default of SEED: 0); with "
                  "several, each --out "
                  "pair.html becomes pair.seed0.html and so on")
      ->check(base::InRange(1, 1000))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kReactionGroup);
  app->add_option(
         "--out", arguments->outputs,
         absl::StrCat("File to write: .html (a page to watch), ", formats::kWritableExtensions,
                      ", of which .bvh makes two files; repeatable; - for standard output"))
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE")
      ->group(kOutputGroup);
  AddOutputFormatFlag(app, &arguments->output_format);
  app->add_flag("--json", arguments->json, "Print the summary as JSON")->group(kOutputGroup);
  app->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kOutputGroup);
  AddServerFlags(app, &arguments->server);
  app->footer(kExitCodesFooter);
  app->callback([arguments] { CheckTogether(*arguments); });
}

}  // namespace

Command AddSynthesizeCommand(CLI::App* program) {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  CLI::App* app = program->add_subcommand("synthesize", "Synthesise the follower of a leader");
  AddFlags(app, arguments.get());
  return MakeServerCommand(app, arguments, RunSynthesize);
}

}  // namespace duet::client::cli
