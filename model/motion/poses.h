#ifndef DUET_MODEL_MOTION_POSES_H_
#define DUET_MODEL_MOTION_POSES_H_

#include <cstddef>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// The positions of one character's joints in every frame.
//
// Shapes: [frames, joints], row-major (all joints of frame 0 first).
// Units:  metres, right-handed, y up, unless the owner specifies otherwise.
//
//   Poses poses(frames, joints);
//   poses.at(0, root) = {0, 1, 0};
//   for (int t = 0; t < poses.frame_count(); ++t) Draw(poses[t]);   // joints of frame t
//   for (Vec3& position : poses.all()) position += offset;
class Poses {
 public:
  Poses() = default;
  // All joints at the origin.
  Poses(int frame_count, int joint_count)
      : joint_count_(joint_count),
        positions_(static_cast<std::size_t>(frame_count) * static_cast<std::size_t>(joint_count)) {}
  // Requires that `positions` holds whole frames.
  Poses(int joint_count, std::vector<Vec3> positions)
      : joint_count_(joint_count), positions_(std::move(positions)) {}

  int joint_count() const { return joint_count_; }
  int frame_count() const {
    return joint_count_ == 0 ? 0 : static_cast<int>(positions_.size()) / joint_count_;
  }
  bool empty() const { return positions_.empty(); }

  // The joints of one frame.
  absl::Span<Vec3> operator[](int frame) { return {positions_.data() + Row(frame), Width()}; }
  absl::Span<const Vec3> operator[](int frame) const {
    return {positions_.data() + Row(frame), Width()};
  }
  Vec3& at(int frame, int joint) { return (*this)[frame][static_cast<std::size_t>(joint)]; }
  const Vec3& at(int frame, int joint) const {
    return (*this)[frame][static_cast<std::size_t>(joint)];
  }

  // All positions, and those of `count` frames from frame `first`, in row-major order.
  absl::Span<Vec3> all() { return absl::MakeSpan(positions_); }
  absl::Span<const Vec3> all() const { return positions_; }
  absl::Span<const Vec3> frames(int first, int count) const {
    return {positions_.data() + Row(first), static_cast<std::size_t>(count) * Width()};
  }

  // Appends whole frames of joint_count() joints.
  void Append(absl::Span<const Vec3> frames) {
    positions_.insert(positions_.end(), frames.begin(), frames.end());
  }
  // Truncates to `count` frames, or appends frames with all joints at the origin.
  void Resize(int count) { positions_.resize(Row(count)); }
  // Removes the first `count` frames.
  void DropFront(int count) {
    positions_.erase(positions_.begin(),
                     positions_.begin() + static_cast<std::ptrdiff_t>(Row(count)));
  }

  friend bool operator==(const Poses& a, const Poses& b) {
    return a.joint_count_ == b.joint_count_ && a.positions_ == b.positions_;
  }
  friend bool operator!=(const Poses& a, const Poses& b) { return !(a == b); }

 private:
  std::size_t Width() const { return static_cast<std::size_t>(joint_count_); }
  std::size_t Row(int frame) const { return static_cast<std::size_t>(frame) * Width(); }

  int joint_count_ = 0;
  std::vector<Vec3> positions_;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_POSES_H_
