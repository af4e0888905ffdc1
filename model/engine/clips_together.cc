#include "model/engine/clips_together.h"

#include <cstddef>
#include <utility>

#include "model/motion/resample.h"

namespace duet::engine {

LiveClip::LiveClip(const ModelDescription& model, ClipRequest request, int delay_frames)
    : leader_(std::move(request.leader)),
      labels_(std::move(request.labels)),
      weights_(static_cast<std::size_t>(model.class_count())),
      live_(model, {request.frame_rate_hz, delay_frames, LabelTrack(WeightsAt(0)),
                    std::move(request.start), request.partner_direction, request.options}) {
  motion::Poses none(0, leader_.joint_count());
  Advance(&none);
}

motion::Poses LiveClip::Accept(const motion::Poses& follower) {
  live_.Accept(follower);
  motion::Poses final_frames(0, leader_.joint_count());
  Advance(&final_frames);
  return final_frames;
}

std::vector<float> LiveClip::WeightsAt(int frame) {
  labels_.At(frame, weights_.data());
  return weights_;
}

void LiveClip::AddFrame() {
  const std::vector<float> before = weights_;
  // A caller who changes labels does not know them earlier.
  if (next_frame_ > 0 && WeightsAt(next_frame_) != before) {
    live_.ChangeLabels(next_frame_, 0, weights_);
  }
  live_.AddLeader(motion::Part(leader_, next_frame_, 1));
  ++next_frame_;
}

void LiveClip::Advance(motion::Poses* final_frames) {
  while (true) {
    const LiveFrames due = live_.TakeDue();
    if (due.poses.frame_count() > 0) {
      final_frames->Append(due.poses.all());
      live_.Settle(due.poses);
    } else if (live_.NeedsWindow()) {
      return;
    } else if (next_frame_ < leader_.frame_count()) {
      AddFrame();
    } else if (live_.done()) {
      return;
    } else {
      live_.EndLeader();
    }
  }
}

}  // namespace duet::engine
