#ifndef DUET_CLIENT_CLI_LIVE_FILE_SINK_H_
#define DUET_CLIENT_CLI_LIVE_FILE_SINK_H_

#include <filesystem>
#include <string>
#include <vector>

#include "client/cli/live_arguments.h"
#include "client/live/follower_sink.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// Keeps a whole session, and writes it at its end: the follower alone to a motion file, both people
// to a page. Files name the labels of the beginning, not later changes. A file that cannot be
// created is reported at the start, before any motion would be lost.
class LiveFileSink final : public live::FollowerSink {
 public:
  LiveFileSink(std::filesystem::path path, LiveArguments arguments, motion::Skeleton skeleton)
      : path_(std::move(path)), arguments_(std::move(arguments)), skeleton_(std::move(skeleton)) {}

  absl::Status Start(const live::LeaderFormat& format) override;
  absl::Status Accept(const LiveFrames& frames) override;
  void AcceptLeader(const live::LeaderFrame& frame) override;
  absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) override;

 private:
  const std::filesystem::path path_;
  const LiveArguments arguments_;
  const motion::Skeleton skeleton_;
  motion::Clip leader_, follower_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_FILE_SINK_H_
