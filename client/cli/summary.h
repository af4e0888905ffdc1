#ifndef DUET_CLIENT_CLI_SUMMARY_H_
#define DUET_CLIENT_CLI_SUMMARY_H_

#include <string>
#include <vector>

#include "client/cli/output.h"
#include "client/live/live_run.h"
#include "nlohmann/json_fwd.hpp"

// The summaries of duet synthesize and duet live, for people and for programs.

namespace duet::client::cli {

// The request and the answer. `notes`: on how the leader was read.
std::string DescribeSynthesis(const Synthesis& synthesis, const WrittenFiles& written,
                              const std::vector<std::string>& notes);
nlohmann::json SynthesisJson(const Synthesis& synthesis, const WrittenFiles& written,
                             const std::vector<std::string>& notes);

std::string DescribeLive(const live::LiveReport& report);
std::string LiveJson(const live::LiveReport& report);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SUMMARY_H_
