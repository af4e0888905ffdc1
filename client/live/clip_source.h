#ifndef DUET_CLIENT_LIVE_CLIP_SOURCE_H_
#define DUET_CLIENT_LIVE_CLIP_SOURCE_H_

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "client/live/ends.h"
#include "model/motion/clip.h"

namespace duet::client::live {

// A motion that is complete, played at its frame rate or as fast as the follower answers.
class ClipSource final : public LeaderSource {
 public:
  ClipSource(motion::Clip clip, bool realtime, std::vector<std::string> notes)
      : clip_(std::move(clip)), realtime_(realtime), notes_(std::move(notes)) {}

  absl::StatusOr<LeaderFormat> Open() override;
  absl::StatusOr<std::optional<LeaderEvent>> Next() override;
  void Stop() override;
  bool IsLive() const override { return realtime_; }
  std::vector<std::string> Notes() const override { return notes_; }

 private:
  bool WaitForFrame();

  const motion::Clip clip_;
  const bool realtime_;
  const std::vector<std::string> notes_;
  int next_ = 0;
  std::chrono::steady_clock::time_point begin_;
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stopped_ = false;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_CLIP_SOURCE_H_
