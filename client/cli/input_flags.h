#ifndef DUET_CLIENT_CLI_INPUT_FLAGS_H_
#define DUET_CLIENT_CLI_INPUT_FLAGS_H_

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/cli/flag_set.h"
#include "client/cli/motion_arguments.h"

namespace duet::client::cli {

// How motion files are to be read: --frame-rate, --unit, --joint-map and so on.
void AddInputFlags(FlagSet* app, InputArguments* input);

// The values of --input-format.
std::vector<std::string> InputFormatNames();

// --output-format, of what goes to standard output.
void AddOutputFormatFlag(FlagSet* app, std::optional<OutputFormat>* format);

// --bvh-unit and --bvh-keys-per-frame, of what is written.
void AddBvhFlags(FlagSet* app, BvhArguments* bvh);

// Rejects these flags without an output in BVH.
void CheckBvhFlags(const FlagSet& command, const std::vector<std::filesystem::path>& outputs,
                   const std::optional<OutputFormat>& format);

// Whether one of the outputs has this format; `format` is that of standard output.
bool WritesFormat(formats::Format wanted, const std::vector<std::filesystem::path>& outputs,
                  const std::optional<OutputFormat>& format);

// What standard output cannot take: several results, a summary besides, a result without
// --output-format. Throws what CLI11 reports as a usage error.
void CheckStandardOutput(const std::vector<std::filesystem::path>& outputs,
                         const std::optional<OutputFormat>& format, bool json);

// Whether one of the outputs is standard output.
bool WritesToStandardOutput(const std::vector<std::filesystem::path>& outputs);

extern const std::map<std::string, formats::Side> kSides;

inline constexpr char kInputGroup[] = "Input";
inline constexpr char kOutputGroup[] = "Output";

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_INPUT_FLAGS_H_
