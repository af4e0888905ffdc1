#include "model/motion/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/motion/motion_limits.h"

namespace duet::motion {
namespace {

// Prevents rounding a duration that is a whole number of frames up to one more frame.
constexpr double kFrameTolerance = 1e-6;

struct Position {
  int frame;
  float fraction;
};

Position Locate(int frames, double frame) {
  const double held = std::clamp(frame, 0.0, static_cast<double>(frames - 1));
  const int whole = static_cast<int>(held);
  return {whole, static_cast<float>(held - whole)};
}

absl::Span<const Vec3> HeldFrame(const Poses& poses, int frame) {
  return poses[std::clamp(frame, 0, poses.frame_count() - 1)];
}

}  // namespace

int ResampledFrameCount(int frames, double from_hz, double to_hz) {
  const double last = (frames - 1) * to_hz / from_hz;
  return std::max(2, static_cast<int>(std::ceil(last - kFrameTolerance)) + 1);
}

void SampleLinear(const Poses& poses, double frame, absl::Span<Vec3> out) {
  const Position at = Locate(poses.frame_count(), frame);
  const absl::Span<const Vec3> a = HeldFrame(poses, at.frame);
  const absl::Span<const Vec3> b = HeldFrame(poses, at.frame + 1);
  for (std::size_t j = 0; j < out.size(); ++j) out[j] = Lerp(a[j], b[j], at.fraction);
}

void SampleCubic(const Poses& poses, double frame, absl::Span<Vec3> out) {
  const Position at = Locate(poses.frame_count(), frame);
  const absl::Span<const Vec3> p0 = HeldFrame(poses, at.frame - 1);
  const absl::Span<const Vec3> p1 = HeldFrame(poses, at.frame);
  const absl::Span<const Vec3> p2 = HeldFrame(poses, at.frame + 1);
  const absl::Span<const Vec3> p3 = HeldFrame(poses, at.frame + 2);
  const float t = at.fraction, t2 = t * t, t3 = t2 * t;
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j] = 0.5f * ((2.0f * p1[j]) + (p2[j] - p0[j]) * t +
                     (2.0f * p0[j] - 5.0f * p1[j] + 4.0f * p2[j] - p3[j]) * t2 +
                     (3.0f * p1[j] - p0[j] - 3.0f * p2[j] + p3[j]) * t3);
  }
}

Poses Part(const Poses& poses, int first, int count) {
  Poses part(0, poses.joint_count());
  part.Append(poses.frames(first, count));
  return part;
}

Poses Resample(const Poses& poses, double from_hz, double to_hz) {
  Poses out(ResampledFrameCount(poses.frame_count(), from_hz, to_hz), poses.joint_count());
  for (int t = 0; t < out.frame_count(); ++t) SampleLinear(poses, t * from_hz / to_hz, out[t]);
  return out;
}

absl::Status ResampleByRate(absl::string_view field, double rate_hz, Clip* clip) {
  absl::Status status = CheckFrameRate(field, rate_hz);
  if (!status.ok()) return status;
  const double step = clip->frame_rate_hz / rate_hz;
  const double frames = std::floor((clip->frame_count() - 1) / step + kFrameTolerance) + 1;
  if (frames > kMaxMotionFrames) {
    return absl::InvalidArgumentError(absl::StrCat(field, ": expected at most ", kMaxMotionFrames,
                                                   " frames, got ", frames, " at ", rate_hz,
                                                   " Hz"));
  }
  Poses poses(static_cast<int>(frames), clip->joint_count());
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    SampleCubic(clip->poses, frame * step, poses[frame]);
  }
  clip->poses = std::move(poses);
  clip->frame_rate_hz = rate_hz;
  return absl::OkStatus();
}

}  // namespace duet::motion
