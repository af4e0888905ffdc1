#include "model/evaluation/experiments/live_clip.h"

#include <cstddef>
#include <utility>

namespace duet::evaluation::experiments {

LiveClip::LiveClip(const engine::ModelDescription& model, engine::ClipRequest request,
                   int delay_frames)
    : leader_(std::move(request.leader)),
      labels_(std::move(request.labels)),
      weights_(static_cast<std::size_t>(model.class_count())),
      live_(model, {request.frame_rate_hz, delay_frames, engine::LabelTrack(WeightsAt(0)),
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
  live_.AddLeader(motion::Poses(leader_.joint_count(),
                                {leader_[next_frame_].begin(), leader_[next_frame_].end()}));
  ++next_frame_;
}

void LiveClip::Advance(motion::Poses* final_frames) {
  for (;;) {
    const engine::LiveFrames due = live_.TakeDue();
    if (due.poses.frame_count() > 0) {
      final_frames->Append(due.poses.all());
      live_.Settle(due.poses);
      continue;
    }
    if (live_.NeedsWindow()) return;
    if (next_frame_ == leader_.frame_count()) {
      if (live_.done()) return;
      live_.EndLeader();
      continue;
    }
    AddFrame();
  }
}

}  // namespace duet::evaluation::experiments
