#ifndef DUET_CLIENT_CLI_REPORT_H_
#define DUET_CLIENT_CLI_REPORT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/cli/output.h"
#include "client/cli/style.h"
#include "client/result.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// The output of the program: text for people, JSON for programs. Every text ends with a newline.

std::string DescribeModels(const std::vector<ModelInfo>& models);
std::string ModelsJson(const std::vector<ModelInfo>& models);

// The request, which is the same for every sample; and the answer to one of them.
std::string DescribeRequest(const Synthesis& synthesis, const std::vector<std::string>& notes);
std::string DescribeAnswer(const Synthesis& synthesis, const WrittenFiles& written);

// Both as JSON, for one sample. SamplesJson prints the object of a single sample, or
// {"samples": [object, ...]}.
nlohmann::json SynthesisJson(const Synthesis& synthesis, const WrittenFiles& written,
                             const std::vector<std::string>& notes);
std::string SamplesJson(const std::vector<nlohmann::json>& samples);

// The error, with one line for every rejected field, and a hint.
std::string DescribeFailure(const absl::Status& status, const std::string& server_address,
                            const Style& style);
// The flag that fixes how a file was read: "Specify it with --frame-rate HZ.\n"; empty if there is
// none.
std::string DescribeAdvice(const absl::Status& status);

// The JSON text that this program prints.
std::string Print(const nlohmann::json& value);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REPORT_H_
