#ifndef DUET_CLIENT_CLI_LIVE_ARGUMENTS_H_
#define DUET_CLIENT_CLI_LIVE_ARGUMENTS_H_

#include <string>
#include <vector>

#include "client/cli/synthesize_arguments.h"

namespace duet::client::cli {

// The flags of duet live. Of the flags of duet synthesize, it has those that describe the leader's
// file, the reaction and the server; `leader` is the file of --from, if it is one.
struct LiveArguments : SynthesizeArguments {
  std::string from;
  std::vector<std::string> to;
  bool realtime = false;
  int delay_frames = 0;
  int plan_frames = 0;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_ARGUMENTS_H_
