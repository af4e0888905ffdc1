#ifndef DUET_CLIENT_CLI_REPORT_H_
#define DUET_CLIENT_CLI_REPORT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/cli/output.h"
#include "client/result.h"

namespace duet::client::cli {

// What the program prints: text for people, JSON for programs. Every text ends with a line end.

std::string DescribeModels(const std::vector<ModelInfo>& models);
std::string ModelsJson(const std::vector<ModelInfo>& models);

std::string DescribeSynthesis(const Synthesis& synthesis,
                              const std::vector<std::filesystem::path>& written,
                              const std::vector<std::string>& notes);
std::string SynthesisJson(const Synthesis& synthesis,
                          const std::vector<std::filesystem::path>& written,
                          const std::vector<std::string>& notes);

// Why it failed, one line for every refused field, and what may help.
std::string DescribeFailure(const absl::Status& status, const std::string& server_address);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REPORT_H_
