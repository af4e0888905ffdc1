#ifndef DUET_CLIENT_CLI_SYNTHESIS_REPORT_H_
#define DUET_CLIENT_CLI_SYNTHESIS_REPORT_H_

#include <string>
#include <vector>

#include "client/cli/output.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// The request, which is the same for every sample; and the answer to one of them.
std::string DescribeRequest(const Synthesis& synthesis, const std::vector<std::string>& notes);
std::string DescribeAnswer(const Synthesis& synthesis, const WrittenFiles& written);

// Both as JSON, for one sample.
nlohmann::json SynthesisJson(const Synthesis& synthesis, const WrittenFiles& written,
                             const std::vector<std::string>& notes);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIS_REPORT_H_
