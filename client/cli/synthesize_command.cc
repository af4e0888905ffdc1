#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/output.h"
#include "client/cli/reaction.h"
#include "client/cli/report.h"
#include "client/cli/server.h"
#include "client/cli/summary.h"
#include "client/model_skeleton.h"
#include "model/formats/motion_file.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

using Paths = std::vector<std::filesystem::path>;

struct SynthesizeArguments : ReactionArguments {
  ServerArguments server;
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
  if (arguments.output_format && arguments.output_format->motion == formats::Format::kBvh) {
    RejectFlag("--output-format",
               "bvh cannot be used with --out -: it has one file for each person");
  }
  for (const std::filesystem::path& output : arguments.outputs) {
    const absl::Status status = CheckOutput(output, {});
    if (!status.ok()) RejectFlag("--out", std::string(status.message()));
  }
}

// Checks what the flags and the request's file decide together, before the first call.
absl::Status CheckRequest(const SynthesizeArguments& arguments, const SynthesisRequest& request) {
  if (request.rotations && !HoldsRotations(arguments)) {
    return absl::InvalidArgumentError(
        absl::StrCat("reply_rotations: expected --out FILE.json, which holds them, got --out ",
                     OutputsText(arguments.outputs)));
  }
  const Paths inputs = {arguments.leader, arguments.follower_start, arguments.request};
  for (const std::filesystem::path& output : arguments.outputs) {
    for (const std::filesystem::path& file : PairFiles(output)) {
      absl::Status status = CheckReplacesNone(file, inputs);
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<WrittenFiles> WriteAll(const SynthesizeArguments& arguments,
                                      const Synthesis& synthesis, std::ostream& out) {
  WrittenFiles written;
  for (const std::filesystem::path& output : arguments.outputs) {
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

absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment) {
  const absl::Status inputs = CheckInputs(arguments);
  if (!inputs.ok()) return inputs;
  absl::StatusOr<SynthesisRequest> request = StartRequest(arguments);
  if (!request.ok()) return request.status();
  absl::Status status = CheckRequest(arguments, *request);
  if (!status.ok()) return status;
  const absl::StatusOr<Client> client = Connect(arguments.server, environment);
  if (!client.ok()) return client.status();
  const absl::StatusOr<ModelDetails> details = client->GetModel(request->model);
  if (!details.ok()) return details.status();
  status = CheckLabels(*request, details->model);
  if (!status.ok()) return status;
  const absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  std::vector<std::string> notes;  // on how the leader was read
  status = ReadMotions(arguments, *skeleton, environment.in, &*request, &notes);
  if (!status.ok()) return status;
  absl::StatusOr<SynthesisResult> result = client->Synthesize(*request);
  if (!result.ok()) return result.status();
  const Synthesis synthesis{*std::move(request), *std::move(result), *skeleton,
                            arguments.leader.empty() ? arguments.request : arguments.leader,
                            details->model.samples};
  const absl::StatusOr<WrittenFiles> written = WriteAll(arguments, synthesis, *environment.out);
  if (!written.ok()) return written.status();
  if (arguments.quiet) return absl::OkStatus();
  // With a motion on standard output, the summary goes to standard error.
  std::ostream& out =
      WritesToStandardOutput(arguments.outputs) ? *environment.err : *environment.out;
  out << (arguments.json ? Print(SynthesisJson(synthesis, *written, notes))
                         : DescribeSynthesis(synthesis, *written, notes));
  return absl::OkStatus();
}

void AddFlags(CLI::App* app, SynthesizeArguments* arguments) {
  app->add_option("--leader", arguments->leader,
                  absl::StrCat("Motion of the leader: ", formats::kReadableExtensions,
                               "; - for standard input"))
      ->type_name("FILE")
      ->group(kInputGroup);
  AddLeaderFlags(app, arguments);
  AddReactionFlags(app, arguments);
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
