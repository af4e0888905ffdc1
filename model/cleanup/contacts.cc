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
// Smooths the motion with which the body follows its feet.
constexpr double kBodySmoothSeconds = 0.13;

float Float(double value) { return static_cast<float>(value); }

// Whether a foot stands in each frame, with hysteresis. Shapes: smooth [frames].
std::vector<bool> Stands(const std::vector<Vec3>& smooth, float floor,
                         const ContactOptions& options, const Timing& timing) {
  const int last = static_cast<int>(smooth.size()) - 1;
  std::vector<bool> stands;
  bool now = false;
  for (int t = 0; t <= last; ++t) {
    const int before = std::max(0, t - 1), after = std::min(last, t + 1);
    const float way =
        Distance(smooth[static_cast<std::size_t>(after)], smooth[static_cast<std::size_t>(before)]);
    const float speed = way * Float(timing.frame_rate_hz) / Float(std::max(1, after - before));
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

// The weight of a contact in a frame: 1 within the contact, fading out around it.
float HoldAt(const Contact& contact, int frame, const ContactOptions& options,
             const Timing& timing) {
  const int outside = std::max({0, contact.begin - frame, frame - (contact.end - 1)});
  return SmoothStep(1 - outside / (timing.Frames(options.ease_seconds) + 1));
}

// The correction of a foot along the floor in a frame.
Vec3 HoldInFrame(const std::vector<Contact>& contacts, Vec3 foot, int frame,
                 const ContactOptions& options, const Timing& timing) {
  Vec3 sum;
  float weights = 0;
  for (const Contact& contact : contacts) {
    // A contact that began in settled frames continues without easing in.
    const float ease = contact.begin < timing.settled ? 1 : EaseIn(timing, frame);
    const float weight = ease * HoldAt(contact, frame, options, timing);
    sum += (contact.place - foot) * weight;
    weights += weight;
  }
  const Vec3 hold = sum / std::max(1.0f, weights);
  return {hold.x, 0, hold.z};
}

// The corrections of all frames; zero in settled ones. Shapes: foot [frames]; returns [frames].
std::vector<Vec3> Holds(const std::vector<Vec3>& foot, float floor, const ContactOptions& options,
                        const Timing& timing) {
  const std::vector<Contact> contacts = FindContacts(foot, floor, options, timing);
  std::vector<Vec3> holds(foot.size());
  for (std::size_t t = static_cast<std::size_t>(timing.settled); t < foot.size(); ++t) {
    holds[t] = HoldInFrame(contacts, foot[t], static_cast<int>(t), options, timing);
  }
  return holds;
}

}  // namespace

std::vector<Contact> FindContacts(const std::vector<Vec3>& foot, float floor,
                                  const ContactOptions& options, const Timing& timing) {
  const int frames = static_cast<int>(foot.size());
  const int first = std::max(0, timing.settled - 1);
  const std::vector<Vec3> smooth = LowPass(foot, timing.Frames(kSmoothSeconds));
  const std::vector<bool> stands = Stands(smooth, floor, options, timing);
  std::vector<Contact> contacts;
  for (int begin = first; begin < frames;) {
    const bool goes_on = begin == first && timing.settled > 0;
    const Vec3 from =
        goes_on ? foot[static_cast<std::size_t>(begin)] : smooth[static_cast<std::size_t>(begin)];
    int end = begin;
    while (end < frames && stands[static_cast<std::size_t>(end)] &&
           Distance(smooth[static_cast<std::size_t>(end)], from) < Float(options.farthest_metres)) {
      ++end;
    }
    if (end > begin && (goes_on || end - begin >= timing.Frames(options.shortest_seconds))) {
      contacts.push_back({begin, end, goes_on ? from : Mean(foot, begin, end)});
    }
    begin = std::max(end, begin + 1);
  }
  return contacts;
}

void HoldContacts(const motion::Skeleton& skeleton, const Body& body, float floor,
                  const ContactOptions& options, const Timing& timing, motion::Poses* poses) {
  if (body.legs.empty()) return;
  const std::size_t frames = static_cast<std::size_t>(poses->frame_count());
  std::vector<std::vector<Vec3>> places;  // corrected positions of each foot
  std::vector<Vec3> shifts(frames);
  for (const Limb& leg : body.legs) {
    std::vector<Vec3> foot;
    for (int t = 0; t < poses->frame_count(); ++t) foot.push_back(poses->at(t, leg.end));
    const std::vector<Vec3> holds = Holds(foot, floor, options, timing);
    for (std::size_t t = 0; t < frames; ++t) {
      foot[t] += holds[t];
      shifts[t] += holds[t] / Float(static_cast<double>(body.legs.size()));
    }
    places.push_back(foot);
  }
  shifts = LowPass(shifts, timing.Frames(kBodySmoothSeconds));
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    for (Vec3& joint : (*poses)[t]) joint += shifts[at] * EaseIn(timing, t);
    const Vec3 forward = skeleton.hips ? Facing(*skeleton.hips, (*poses)[t]) : Vec3{};
    for (std::size_t leg = 0; leg < places.size(); ++leg) {
      Reach(body.legs[leg], places[leg][at], forward, (*poses)[t]);
    }
  }
}

}  // namespace duet::cleanup
