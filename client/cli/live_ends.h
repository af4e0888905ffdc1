#ifndef DUET_CLIENT_CLI_LIVE_ENDS_H_
#define DUET_CLIENT_CLI_LIVE_ENDS_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/live_arguments.h"
#include "client/cli/program_environment.h"
#include "client/live/follower_sink.h"
#include "client/live/leader_source.h"
#include "client/request.h"
#include "model/motion/skeleton.h"

// The two ends of duet live: what the values of --from and --to mean. A new kind of source or sink
// is added here.
namespace duet::client::cli {

// Whether a value names a file.
bool IsFile(const std::string& value);

// A source, and the reaction that the flags request, which depends on the leader's file.
struct LiveInput {
  std::unique_ptr<live::LeaderSource> source;
  LiveRequest request;  // without joints and frame rate
};
// `on_note` receives warnings about the leader while it is read.
absl::StatusOr<LiveInput> OpenSource(const LiveArguments& arguments,
                                     const motion::Skeleton& skeleton,
                                     const ProgramEnvironment& environment,
                                     const std::function<void(const std::string&)>& on_note);

// Checks a value of --to before any work is done: it may not replace a file that is read.
absl::Status CheckSink(const std::string& to, const LiveArguments& arguments);

absl::StatusOr<std::unique_ptr<live::FollowerSink>> OpenSink(const std::string& to,
                                                             const LiveArguments& arguments,
                                                             const motion::Skeleton& skeleton,
                                                             const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_ENDS_H_
