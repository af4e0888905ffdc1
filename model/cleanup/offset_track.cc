#include "model/cleanup/offset_track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/resample.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// The largest slope of SmoothStep.
constexpr double kSteepest = 1.5;
constexpr double kNever = std::numeric_limits<double>::infinity();
// Frames. Two offsets of the same frame still have an order.
constexpr double kShortestGap = 1e-3;
// After so many corrections, the spline between two frames passes through the offset.
constexpr int kRounds = 2;

// The frame before which the correction is zero; infinitely early without settled frames.
double Begin(const Timing& timing) { return timing.settled > 0 ? timing.settled - 1 : -kNever; }

Vec3 Shortened(Vec3 v, double most) {
  const double length = Norm(v);
  return length > most ? v * static_cast<float>(most / length) : v;
}

// Shortens each offset so far that the way from the one before it is not too fast.
void LimitSpeed(const OffsetLimits& limits, const Timing& timing, std::vector<Offset>* offsets) {
  double before = Begin(timing);
  Vec3 way;
  for (Offset& offset : *offsets) {
    const double most = limits.fastest_metres_per_second * (offset.frame - before) /
                        (kSteepest * timing.frame_rate_hz);
    offset.way = way + Shortened(offset.way - way, most);
    before = offset.frame;
    way = offset.way;
  }
}

// The frames in which an offset comes or goes.
double EaseFrames(const Offset& offset, const OffsetLimits& limits, const Timing& timing,
                  double gap) {
  const double gentle = kSteepest * Norm(offset.way) / limits.gentle_metres_per_second;
  return std::clamp(timing.Frames(std::max(limits.ease_seconds, gentle)), kShortestGap,
                    std::max(kShortestGap, gap));
}

// The corrections of all frames: each offset comes, is there at its time, and goes.
std::vector<Vec3> Eased(const std::vector<Offset>& offsets, const OffsetLimits& limits,
                        const Timing& timing, int frames) {
  std::vector<Vec3> track(static_cast<std::size_t>(frames));
  std::size_t next = 0;  // the first offset after the frame
  for (int t = timing.settled; t < frames; ++t) {
    while (next < offsets.size() && offsets[next].frame <= t) ++next;
    const Offset* last = next > 0 ? &offsets[next - 1] : nullptr;
    const Offset* coming = next < offsets.size() ? &offsets[next] : nullptr;
    const double end = coming ? coming->frame : kNever;
    const double begin = last ? last->frame : Begin(timing);
    Vec3& at = track[static_cast<std::size_t>(t)];
    if (last) {
      const double ease = EaseFrames(*last, limits, timing, end - begin);
      at += last->way * (1 - SmoothStep((t - begin) / ease));
    }
    if (coming) {
      const double ease = EaseFrames(*coming, limits, timing, end - begin);
      at += coming->way * (1 - SmoothStep((end - t) / ease));
    }
  }
  return track;
}

// Where the spline through a track is at a time.
Vec3 At(const std::vector<Vec3>& track, double frame) {
  Vec3 at;
  SampleCubic(motion::Poses(1, track), frame, absl::MakeSpan(&at, 1));
  return at;
}

}  // namespace

std::vector<Vec3> OffsetTrack(std::vector<Offset> offsets, const OffsetLimits& limits,
                              const Timing& timing, int frames) {
  LimitSpeed(limits, timing, &offsets);
  const std::vector<Offset> wanted = offsets;
  std::vector<Vec3> track = Eased(offsets, limits, timing, frames);
  for (int round = 0; round < kRounds; ++round) {
    bool between_frames = false;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const double frame = wanted[i].frame;
      if (frame == std::floor(frame) || frame > frames - 1) continue;
      offsets[i].way += wanted[i].way - At(track, frame);
      between_frames = true;
    }
    if (!between_frames) break;
    track = Eased(offsets, limits, timing, frames);
  }
  return track;
}

}  // namespace duet::cleanup
