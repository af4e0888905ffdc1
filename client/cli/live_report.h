#ifndef DUET_CLIENT_CLI_LIVE_REPORT_H_
#define DUET_CLIENT_CLI_LIVE_REPORT_H_

#include <string>

#include "client/live/live_run.h"

namespace duet::client::cli {

// The summary of a run, for people and for programs.
std::string DescribeLive(const live::LiveReport& report);
std::string LiveJson(const live::LiveReport& report);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_REPORT_H_
