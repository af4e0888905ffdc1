#ifndef DUET_CLIENT_INTERNAL_FRAME_LOG_H_
#define DUET_CLIENT_INTERNAL_FRAME_LOG_H_

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::client::internal {

// The last frames of a motion that grows: consecutive frames, counted from its beginning.
class FrameLog {
 public:
  explicit FrameLog(int joint_count) : poses_(0, joint_count) {}

  // Kept are the frames [first(), end()).
  int first() const { return first_; }
  int end() const { return first_ + poses_.frame_count(); }

  // Requires whole frames.
  void Append(absl::Span<const motion::Vec3> frames) { poses_.Append(frames); }
  // [joints]
  absl::Span<const motion::Vec3> operator[](int frame) const { return poses_[frame - first_]; }
  // [count, joints]
  absl::Span<const motion::Vec3> Frames(int first, int count) const {
    return poses_.frames(first - first_, count);
  }

  // Keeps the frames from `frame` on, and perhaps some before it: it drops many at a time, because
  // that moves the others.
  void DropBefore(int frame) {
    const int dropped = frame - first_;
    if (dropped < kChunk || dropped > poses_.frame_count()) return;
    poses_.DropFront(dropped);
    first_ = frame;
  }

 private:
  static constexpr int kChunk = 256;

  int first_ = 0;
  motion::Poses poses_;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_FRAME_LOG_H_
