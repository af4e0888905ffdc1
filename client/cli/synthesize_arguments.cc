#include "client/cli/synthesize_arguments.h"

#include "absl/strings/str_cat.h"

namespace duet::client::cli {

std::vector<std::filesystem::path> SampleOutputs(const SynthesizeArguments& arguments, int sample) {
  std::vector<std::filesystem::path> outputs = arguments.outputs;
  if (arguments.samples == 1) return outputs;
  for (std::filesystem::path& output : outputs) {
    if (!output.has_extension()) continue;  // rejected later, under the name that the user gave
    output.replace_filename(absl::StrCat(output.stem().string(), ".seed", SeedOf(arguments, sample),
                                         output.extension().string()));
  }
  return outputs;
}

}  // namespace duet::client::cli
