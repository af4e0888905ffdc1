#ifndef DUET_CLIENT_CLI_SUMMARY_H_
#define DUET_CLIENT_CLI_SUMMARY_H_

#include <string>
#include <vector>

#include "client/cli/output.h"
#include "client/live/live_run.h"
#include "nlohmann/json_fwd.hpp"

// The summaries of duet synthesize and duet live, for people and for programs.

namespace duet::client::cli {

// The request, which is the same for every sample; and the answer to one of them.
std::string DescribeRequest(const Synthesis& synthesis, const std::vector<std::string>& notes);
std::string DescribeAnswer(const Synthesis& synthesis, const WrittenFiles& written);
// Both, for one sample.
nlohmann::json SynthesisJson(const Synthesis& synthesis, const WrittenFiles& written,
                             const std::vector<std::string>& notes);

std::string DescribeLive(const live::LiveReport& report);
std::string LiveJson(const live::LiveReport& report);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SUMMARY_H_
