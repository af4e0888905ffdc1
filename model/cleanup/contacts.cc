#include "model/cleanup/contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/cleanup/low_pass.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// Removes the network's jitter before contacts are detected.
constexpr double kSmoothSeconds = 0.08;

float Float(double value) { return static_cast<float>(value); }

// Whether a foot stands in each frame, with hysteresis. Shapes: smooth [frames].
std::vector<bool> Stands(const std::vector<Vec3>& smooth, float floor, double frame_rate_hz,
                         const ContactOptions& options) {
  const int last = static_cast<int>(smooth.size()) - 1;
  std::vector<bool> stands;
  bool now = false;
  for (int t = 0; t <= last; ++t) {
    const int before = std::max(0, t - 1), after = std::min(last, t + 1);
    const float way =
        Distance(smooth[static_cast<std::size_t>(after)], smooth[static_cast<std::size_t>(before)]);
    const float speed = way * Float(frame_rate_hz) / Float(std::max(1, after - before));
    const float height = smooth[static_cast<std::size_t>(t)].y - floor;
    now = speed < Float(now ? options.fast_metres_per_second : options.slow_metres_per_second) &&
          height < Float(now ? options.high_metres : options.low_metres);
    stands.push_back(now);
  }
  return stands;
}

Vec3 Mean(const std::vector<Vec3>& track, int begin, int end) {
  Vec3 sum;
  for (int t = begin; t < end; ++t) sum += track[static_cast<std::size_t>(t)];
  return sum / Float(end - begin);
}

}  // namespace

std::vector<Contact> FindContacts(const std::vector<Vec3>& foot, float floor, double frame_rate_hz,
                                  const ContactOptions& options) {
  const int frames = static_cast<int>(foot.size());
  const std::vector<Vec3> smooth = LowPass(foot, kSmoothSeconds * frame_rate_hz);
  const std::vector<bool> stands = Stands(smooth, floor, frame_rate_hz, options);
  std::vector<Contact> contacts;
  for (int begin = 0; begin < frames;) {
    const Vec3 from = smooth[static_cast<std::size_t>(begin)];
    int end = begin;
    while (end < frames && stands[static_cast<std::size_t>(end)] &&
           Distance(smooth[static_cast<std::size_t>(end)], from) < Float(options.farthest_metres)) {
      ++end;
    }
    if (end > begin && end - begin >= options.shortest_seconds * frame_rate_hz) {
      contacts.push_back({begin, end, Mean(foot, begin, end)});
    }
    begin = std::max(end, begin + 1);
  }
  return contacts;
}

}  // namespace duet::cleanup
