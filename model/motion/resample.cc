#include "model/motion/resample.h"

#include <algorithm>
#include <cmath>

namespace duet::motion {
namespace {

// Keeps a time that is a whole number of frames from being rounded up to one more.
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

const Vec3* Row(const std::vector<Vec3>& positions, int joints, int frame) {
  const int frames = static_cast<int>(positions.size()) / joints;
  const int held = std::clamp(frame, 0, frames - 1);
  return positions.data() + static_cast<size_t>(held) * static_cast<size_t>(joints);
}

}  // namespace

int ResampledFrameCount(int frames, double from_hz, double to_hz) {
  const double last = (frames - 1) * to_hz / from_hz;
  return std::max(2, static_cast<int>(std::ceil(last - kFrameTolerance)) + 1);
}

void SampleLinear(const std::vector<Vec3>& positions, int joints, double frame, Vec3* out) {
  const Position at = Locate(static_cast<int>(positions.size()) / joints, frame);
  const Vec3* a = Row(positions, joints, at.frame);
  const Vec3* b = Row(positions, joints, at.frame + 1);
  for (int j = 0; j < joints; ++j) out[j] = Lerp(a[j], b[j], at.fraction);
}

void SampleCubic(const std::vector<Vec3>& positions, int joints, double frame, Vec3* out) {
  const Position at = Locate(static_cast<int>(positions.size()) / joints, frame);
  const Vec3* p0 = Row(positions, joints, at.frame - 1);
  const Vec3* p1 = Row(positions, joints, at.frame);
  const Vec3* p2 = Row(positions, joints, at.frame + 1);
  const Vec3* p3 = Row(positions, joints, at.frame + 2);
  const float t = at.fraction, t2 = t * t, t3 = t2 * t;
  for (int j = 0; j < joints; ++j) {
    out[j] = 0.5f * ((2.0f * p1[j]) + (p2[j] - p0[j]) * t +
                     (2.0f * p0[j] - 5.0f * p1[j] + 4.0f * p2[j] - p3[j]) * t2 +
                     (3.0f * p1[j] - p0[j] - 3.0f * p2[j] + p3[j]) * t3);
  }
}

std::vector<Vec3> Resample(const std::vector<Vec3>& positions, int joints, double from_hz,
                           double to_hz) {
  const int frames = static_cast<int>(positions.size()) / joints;
  const int out_frames = ResampledFrameCount(frames, from_hz, to_hz);
  std::vector<Vec3> out(static_cast<size_t>(out_frames) * static_cast<size_t>(joints));
  for (int t = 0; t < out_frames; ++t) {
    SampleLinear(positions, joints, t * from_hz / to_hz,
                 out.data() + static_cast<size_t>(t) * static_cast<size_t>(joints));
  }
  return out;
}

}  // namespace duet::motion
