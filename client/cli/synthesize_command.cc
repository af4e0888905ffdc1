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

}  // namespace

absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment) {
  absl::Status inputs = CheckInputs(arguments);
  if (!inputs.ok()) return inputs;
  const absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  const absl::StatusOr<Client> client = environment.connect(*options);
  if (!client.ok()) return client.status();
  const absl::StatusOr<ModelDetails> details = client->GetModel(arguments.model);
  if (!details.ok()) return details.status();

  absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  std::vector<std::string> notes;
  absl::StatusOr<SynthesisRequest> request = BuildRequest(arguments, *skeleton, &notes);
  if (!request.ok()) return request.status();
  absl::StatusOr<SynthesisResult> result = client->Synthesize(*request);
  if (!result.ok()) return result.status();

  const Synthesis synthesis{*std::move(request), *std::move(result), *std::move(skeleton),
                            arguments.leader};
  const absl::StatusOr<Paths> written = WriteAll(arguments.outputs, synthesis);
  if (!written.ok()) return written.status();
  if (arguments.quiet) return absl::OkStatus();
  *environment.out << (arguments.json ? SynthesisJson(synthesis, *written, notes)
                                      : DescribeSynthesis(synthesis, *written, notes));
  return absl::OkStatus();
}

}  // namespace duet::client::cli
