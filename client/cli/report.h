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

// What the program prints: text for people, JSON for programs. Every text ends with a line end.

std::string DescribeModels(const std::vector<ModelInfo>& models);
std::string ModelsJson(const std::vector<ModelInfo>& models);

// What was asked, the same for every sample; and what came of one of them.
std::string DescribeRequest(const Synthesis& synthesis, const std::vector<std::string>& notes);
std::string DescribeAnswer(const Synthesis& synthesis, const WrittenFiles& written);

// Both of one sample; and the text for all samples: the one's object, of several
// {"samples": [object, ...]}.
nlohmann::json SynthesisJson(const Synthesis& synthesis, const WrittenFiles& written,
                             const std::vector<std::string>& notes);
std::string SamplesJson(const std::vector<nlohmann::json>& samples);

// Why it failed, one line for every refused field, and what may help.
std::string DescribeFailure(const absl::Status& status, const std::string& server_address,
                            const Style& style);
// The flag that mends how a file was read: "Say it with --frame-rate HZ.\n"; empty where none does.
std::string DescribeAdvice(const absl::Status& status);

// As this program prints JSON.
std::string Print(const nlohmann::json& value);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REPORT_H_
