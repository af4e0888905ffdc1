#ifndef DUET_CLIENT_CLI_LEADER_WATCH_H_
#define DUET_CLIENT_CLI_LEADER_WATCH_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "client/live/leader_source.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// Passes on the events of another source. If the leader's left and right are swapped, as if the
// sender had forgotten to convert left-handed axes, it reports so once, as `duet inspect` does for
// a file: after kWatchSeconds of frames or at the leader's end.
class LeaderWatch final : public live::LeaderSource {
 public:
  static constexpr double kWatchSeconds = 5;

  // `on_note` is called by the thread that calls Next. Optional.
  LeaderWatch(std::unique_ptr<live::LeaderSource> source, motion::Skeleton skeleton,
              std::function<void(const std::string&)> on_note);

  absl::StatusOr<live::LeaderFormat> Open() override;
  absl::StatusOr<std::optional<live::LeaderEvent>> Next() override;
  void Stop() override { source_->Stop(); }
  bool IsLive() const override { return source_->IsLive(); }
  std::vector<std::string> Notes() const override;

 private:
  void Watch(const live::LeaderFrame& frame);
  void Check();

  const std::unique_ptr<live::LeaderSource> source_;
  const motion::Skeleton skeleton_;
  const std::function<void(const std::string&)> on_note_;
  std::vector<int> source_joints_;  // for each joint of the skeleton, its place in a frame
  motion::Clip seen_;
  bool checked_ = false;
  std::string note_;  // empty: nothing to report
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LEADER_WATCH_H_
